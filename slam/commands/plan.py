"""`roomsketch plan`: a path on a map, or the reason why there is none."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from slam.whole_output import OutputError

NO_PATH = 3


class PlannerName(StrEnum):
    """Who is asked."""

    cones = "cones"
    configuration_space = "configuration-space"
    both = "both"


class Layer(StrEnum):
    """The layers of a map that a robot may be planned on."""

    safety = "safety"
    best = "best"


def plan(
    room: Annotated[
        Path, typer.Argument(help="map.geojson, a floor plan, or any GeoJSON of kinds free, rectangle, or boundary.")
    ],
    start: Annotated[str, typer.Option("--from", help="X,Y[,HEADING] in metres and radians; any heading without.")],
    goal: Annotated[str, typer.Option("--to", help="X,Y[,HEADING]")],
    robot: Annotated[str, typer.Option(help="disc:RADIUS or rectangle:LENGTHxWIDTH, metres.")],
    planner: Annotated[PlannerName, typer.Option(help="Which planner; both compares them.")],
    to: Annotated[Path | None, typer.Option("--out", help="GeoJSON file for the path.")] = None,
    figure: Annotated[Path | None, typer.Option(help="PNG file with what the planner built and found.")] = None,
    layer: Annotated[
        Layer | None, typer.Option(help="The map's inset safety layer (usual), or the best estimate.")
    ] = None,
    sigmas: Annotated[
        float, typer.Option("--clearance-sigmas", min=0, help="Keep off each wall by so many of its own σ: best layer.")
    ] = 0.0,
    settings: Annotated[Path | None, typer.Option(help="TOML file with what differs from the defaults.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a sentence.")] = False,
) -> None:
    """Plan a path; exit code 0 with a path, 3 without, 1 on an error."""
    if figure is not None and figure.suffix.lower() != ".png":
        raise OutputError(f"{figure} does not end in .png, but the figure is a PNG picture: name it so")
    chosen = layer or (Layer.best if sigmas else Layer.safety)
    # Loaded late, what is asked before who answers: the planners bring a compiler with them, and who asks for help or
    # asks amiss is not made to wait for it.
    from slam.plan_question import question_of  # noqa: PLC0415

    question = question_of(room, "safety" if chosen is Layer.safety else "free", sigmas, robot, (start, goal))
    from slam.commands.planned import Wishes, answered  # noqa: PLC0415

    if not answered(question, Wishes(planner.value, settings, to, figure, as_json)):
        raise typer.Exit(NO_PATH)
