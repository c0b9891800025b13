"""`roomsketch plan`: a path on a map, or the reason why there is none."""

import json
from enum import Enum, StrEnum
from pathlib import Path
from typing import Annotated

import typer

from planners.path import Answer
from planners.robot import parse_robot
from planners.world import World
from slam import toml_file
from slam.commands.console import out
from slam.planning import PLANNERS, PlanningSettings, answer_values, parse_pose, path_text
from slam.room_file import free_space
from slam.settings import Settings
from slam.whole_output import write_whole

NO_PATH = 3

PlannerName = Enum("PlannerName", {name: name for name in PLANNERS}, type=str)  # type: ignore[misc]


class Layer(StrEnum):
    """The layers of a map that a robot may be planned on."""

    safety = "safety"
    best = "best"


def plan(
    room: Annotated[Path, typer.Argument(help="map.geojson, or any GeoJSON of kinds free, or boundary and obstacle.")],
    start: Annotated[str, typer.Option("--from", help="X,Y[,HEADING] in metres and radians; any heading without.")],
    goal: Annotated[str, typer.Option("--to", help="X,Y[,HEADING]")],
    robot: Annotated[str, typer.Option(help="disc:RADIUS or rectangle:LENGTHxWIDTH, metres.")],
    planner: Annotated[PlannerName, typer.Option(help="Which planner.")],
    to: Annotated[Path | None, typer.Option("--out", help="GeoJSON file for the path.")] = None,
    layer: Annotated[Layer, typer.Option(help="The map's inset safety layer, or the best estimate.")] = Layer.safety,
    settings: Annotated[Path | None, typer.Option(help="TOML file with what differs from the defaults.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a sentence.")] = False,
) -> None:
    """Plan a path; exit code 0 with a path, 3 without, 1 on an error."""
    opinions = PlanningSettings() if settings is None else toml_file.load(settings, Settings).planning
    free, taken = free_space(room, "safety" if layer is Layer.safety else "free")
    begin, end, body = parse_pose(start), parse_pose(goal), parse_robot(robot)
    answer = PLANNERS[planner.value](World.from_free_space(free), body, begin, end, opinions)
    if to is not None and answer.path is not None:
        write_whole(to, path_text(answer.path, planner.value))
    if as_json:
        print(json.dumps({**answer_values(answer), "layer": taken}))
    else:
        out.print(told(answer))
    if answer.path is None:
        raise typer.Exit(NO_PATH)


def told(answer: Answer) -> str:
    """One answer of a planner as a sentence."""
    if answer.path is None:
        return f"{answer.kind}: {answer.reason}"
    path = answer.path
    return f"path of {path.length:.3f} m, clearance {path.clearance:.3f} m, {len(path.poses)} poses: {answer.reason}"
