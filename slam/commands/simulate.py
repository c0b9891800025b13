"""`roomsketch simulate`: a floor plan becomes a recording with its truth."""

from pathlib import Path
from typing import Annotated

import typer

from slam.commands.console import out
from slam.simulation.record import Recipe
from slam.simulation.record import simulate as simulate_recording


def simulate(
    plan: Annotated[Path, typer.Argument(help="GeoJSON floor plan in metres, with materials, doors and a drive.")],
    to: Annotated[Path, typer.Option("--out", help="Folder for the recording with its truth.")],
    sensor: Annotated[str, typer.Option(help="sonar_infrared, lidar or time_of_flight.")] = "sonar_infrared",
    seed: Annotated[int, typer.Option(min=0, help="Seed of all noise.")] = 0,
    poses: Annotated[Path | None, typer.Option(help="TUM file of true poses, instead of the plan's drive.")] = None,
) -> None:
    """Drive a simulated sensor through a floor plan and record what it reads."""
    simulate_recording(plan, Recipe(sensor, seed), to, poses)
    out.print(f"{to}: recording.toml, readings, truth.geojson, true.tum")
