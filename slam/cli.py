"""The command line: puts the commands together; a foreseen failure is one sentence and exit code 1."""

import sys

import typer

from slam.commands.console import err
from slam.commands.convert import convert
from slam.commands.doctor import doctor
from slam.commands.draw import draw
from slam.commands.floor_plan import floor_plan
from slam.commands.merge import merge
from slam.commands.plan import plan
from slam.commands.score import score
from slam.commands.simulate import simulate
from slam.commands.view import view
from slam.failures import FAILURES

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False)
for command in (merge, score, plan, draw, convert, simulate, floor_plan, view, doctor):
    app.command()(command)


@app.callback()
def _roomsketch() -> None:
    """From scans to one scored room map, and paths on it."""


def main() -> None:
    """Run the command line; a failure that is foreseen is one sentence on standard error and exit code 1."""
    try:
        app()
    except FAILURES as failure:
        err.print(f"roomsketch: {' '.join(str(failure).split())}")
        sys.exit(1)
