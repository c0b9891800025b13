"""The command line: only the command that is called is loaded; a foreseen failure is one sentence and exit code 1."""

import ast
import sys
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import typer

from slam.commands.console import err, out
from slam.failures import is_foreseen

COMMANDS = ("merge", "score", "plan", "draw", "view", "convert", "simulate", "floor_plan", "doctor")


def main() -> None:
    """Run the command line."""
    wanted = sys.argv[1].replace("-", "_") if len(sys.argv) > 1 else ""
    try:
        command_line(wanted)()
    except KeyboardInterrupt:
        err.print("roomsketch: stopped before it began")  # a command that has begun says itself where it stopped
        sys.exit(130)
    except Exception as failure:
        if not is_foreseen(failure):
            raise
        says = f"{failure.filename}: {failure.strerror}" if isinstance(failure, OSError) else str(failure)
        err.print(f"roomsketch: {' '.join(says.split())}")
        sys.exit(1)


def command_line(wanted: str) -> typer.Typer:
    """All commands by name and first line; the one that is wanted ready to run.

    A command brings gtsam, numba or matplotlib with it: whoever only asks for help is not made to wait for them.
    """
    app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False)
    app.callback()(_roomsketch)
    for name in COMMANDS:
        if name == wanted:
            app.command()(getattr(import_module(f"slam.commands.{name}"), name))
        else:
            app.command(name.replace("_", "-"), help=_says(name))(_idle)
    return app


def _tell_version(wanted: bool) -> None:
    if wanted:
        out.print(f"roomsketch {version('roomsketch')}")
        raise typer.Exit


def _roomsketch(
    _: Annotated[
        bool, typer.Option("--version", callback=_tell_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """From scans to one scored room map, and paths on it."""


def _idle() -> None:
    """Stand for a command that was not called."""


def _says(name: str) -> str:
    """The docstring of a command, read without running its file."""
    tree = ast.parse((Path(__file__).parent / "commands" / f"{name}.py").read_text(encoding="utf-8"))
    functions = (node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == name)
    return ast.get_docstring(next(functions)) or ""
