"""`roomsketch plan`: a path on a map, or the reason why there is none."""

import json
from enum import Enum, StrEnum
from math import degrees
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table

from planners.compiled import compiling
from planners.path import Answer
from planners.robot import Robot, parse_robot
from slam import toml_file
from slam.commands.console import err, out
from slam.figures.plans import draw_plans, png_of
from slam.planner_comparison import Trial, compare, trial, trial_values, verdict
from slam.planning import PLANNERS, PlanningSettings, parse_pose, paths_text
from slam.settings import Settings
from slam.whole_output import OutputError, write_whole
from slam.world_file import read_world

NO_PATH = 3
BOTH = "both"

PlannerName = Enum("PlannerName", {name: name for name in (*PLANNERS, BOTH)}, type=str)  # type: ignore[misc]


class Layer(StrEnum):
    """The layers of a map that a robot may be planned on."""

    safety = "safety"
    best = "best"


def plan(
    room: Annotated[
        Path, typer.Argument(help="map.geojson, or any GeoJSON of kinds free, rectangle, or boundary and obstacle.")
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
    opinions = PlanningSettings() if settings is None else toml_file.load(settings, Settings).planning
    chosen = layer or (Layer.best if sigmas else Layer.safety)
    source = read_world(room, "safety" if chosen is Layer.safety else "free", sigmas)
    body, ends = parse_robot(robot), (parse_pose(start), parse_pose(goal))
    question = source.world, body, ends, opinions
    with compiling(announce_compiling):
        trials = compare(*question) if planner.value == BOTH else {planner.value: trial(planner.value, *question)}
    answers = {name: made.answer for name, made in trials.items()}
    found = any(answer.path for answer in answers.values())
    if to is not None and found:
        write_whole(to, paths_text(answers))
    if figure is not None:
        write_whole(figure, png_of(draw_plans(answers, source.world, body, ends)))
    if as_json:
        print(json.dumps({**_values(trials, body), "layer": source.taken}))
    else:
        _print(trials, body)
    if not found:
        raise typer.Exit(NO_PATH)


def announce_compiling() -> None:
    """Say why the first plan takes long."""
    err.print("compiling the planners' loops: once after each installation, up to a minute")


def told(answer: Answer) -> str:
    """One answer of a planner as a sentence."""
    if answer.path is None:
        return f"{answer.kind}: {answer.reason}"
    path = answer.path
    return f"path of {path.length:.3f} m, clearance {path.clearance:.3f} m, {len(path.poses)} poses: {answer.reason}"


def _values(trials: dict[str, Trial], robot: Robot) -> dict[str, Any]:
    """The answer as JSON holds it; of both, each by name and how they compare."""
    values = {name: trial_values(made) for name, made in trials.items()}
    if len(values) == 1:
        return next(iter(values.values()))
    return {**values, "comparison": verdict(trials, robot)}


def _print(trials: dict[str, Trial], robot: Robot) -> None:
    if len(trials) == 1:
        out.print(*(told(made.answer) for made in trials.values()), markup=False)
        return
    table = Table("", "length (m)", "clearance (m)", "turning (°)", "time (s)", "poses", box=None)
    for name, made in trials.items():
        path = made.answer.path
        numbers = (
            ["–"] * 3
            if path is None
            else [f"{path.length:.3f}", f"{path.clearance:.3f}", f"{degrees(path.turning):.0f}"]
        )
        table.add_row(name, *numbers, f"{made.seconds:.3f}", "–" if path is None else str(len(path.poses)))
    out.print(table)
    for name, made in trials.items():
        out.print(f"{name}: {made.answer.reason}", markup=False)
    out.print(verdict(trials, robot), markup=False)
