"""`roomsketch floor-plan`: a floor of a set of drawings becomes a plan that `simulate` drives through."""

from pathlib import Path
from typing import Annotated

import typer

from slam.commands.console import out
from slam.simulation.floors import write_plan
from slam.simulation.mlstruct import convert_mlstruct


def floor_plan(
    drawings: Annotated[Path, typer.Argument(help="The fp.json of MLSTRUCT-FP.")],
    floor: Annotated[int, typer.Argument(help="The floor's number; a wrong one is answered with the known ones.")],
    to: Annotated[Path, typer.Option("--out", help="GeoJSON file for the plan.")],
) -> None:
    """Convert a drawn floor into a floor plan in metres."""
    write_plan(convert_mlstruct(drawings, floor), to)
    out.print(f"{to}: floor {floor} of {drawings.name}")
