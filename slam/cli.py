"""The command line: the only place that prints and ends with an exit code."""

from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from slam import doctor as check_up

app = typer.Typer(no_args_is_help=True, add_completion=False)
out = Console()
err = Console(stderr=True)


@app.callback()
def _roomsketch() -> None:
    """From scans to one scored room map, and paths on it."""


@app.command()
def doctor(
    install: Annotated[bool, typer.Option(help="Fetch open3d's system libraries by apt, where this user may.")] = False,
) -> None:
    """Check the installation and name the remedy for whatever is missing."""
    if install:
        check_up.install_system_libraries(check_up.run_quietly)
    findings = check_up.examine()
    table = Table("", "part", "finding", box=None)
    for finding in findings:
        table.add_row("ok" if finding.in_order else "missing", finding.subject, finding.says)
    out.print(table)
    if any(finding.needed and not finding.in_order for finding in findings):
        raise typer.Exit(1)


def main() -> None:
    """Run the command line."""
    app()
