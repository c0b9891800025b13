"""`roomsketch draw`: the figures of a result, drawn again."""

from pathlib import Path
from typing import Annotated

import typer

from slam.commands.console import out
from slam.figures import gallery
from slam.html_report import write_page
from slam.result_folder import story_of


def draw(result: Annotated[Path, typer.Argument(help="The folder that merge wrote.")]) -> None:
    """Draw the figures of a result again, from its files and its recording."""
    drawn = gallery.draw(story_of(result), result / "figures")
    write_page(result)
    out.print(f"{result / 'figures'}: {', '.join(drawn)}")
