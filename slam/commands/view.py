"""`roomsketch view`: the map in a browser, growing while scans stream in."""

from pathlib import Path
from typing import Annotated

import typer

from slam.commands.console import err, out
from slam.readers.recording import RecordingError
from slam.recordings import guess_format
from slam.result_folder import REPORT, Source, read_report
from slam.serve.gallery import Shown
from slam.serve.guard import is_loopback
from slam.serve.server import open_browser, serve
from slam.serve.truth import Truth

PORT = 8765


def view(
    shown: Annotated[
        Path | None, typer.Argument(metavar="[RUN|RECORDING]", help="A folder that merge wrote, or a recording.")
    ] = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 takes any free one.")] = PORT,
    host: Annotated[
        str, typer.Option(help="Address to serve on; any but this machine's own lets others in.")
    ] = "127.0.0.1",
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only print the address.")] = False,
    format_name: Annotated[str | None, typer.Option("--format", help="The recording's format, if not guessed.")] = None,
) -> None:
    """Show a run or a recording in the browser; Ctrl-C ends it."""
    wanted = None if shown is None else what_to_show(shown, format_name)

    def opened(address: str) -> None:
        out.print(f"{address}   (Ctrl-C ends)")
        if not is_loopback(host):
            err.print(f"anyone who reaches {host} can see the map and have recordings merged here")
        if not no_browser:
            open_browser(address)

    serve(wanted, host, port, opened)


def what_to_show(path: Path, format_name: str | None) -> Shown:
    """The result or recording at `path`, with the truth beside it. Raises ResultError or RecordingError."""
    if not path.exists():
        raise RecordingError(f"{path} does not exist: name a folder that merge wrote, or a recording")
    if (path / REPORT).exists():
        told = read_report(path)["recording"]
        return Shown(Source(path, None), True, Truth.beside(Path(told["path"])))
    if format_name is None:
        guess_format(path)
    return Shown(Source(path, format_name), False, Truth.beside(path))
