"""The command line: the only place that prints and ends with an exit code."""

import json
import sys
from collections.abc import Iterable
from enum import Enum, StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import track
from rich.table import Table

from frontend.scan import Scan
from planners.path import Answer
from planners.robot import parse_robot
from planners.world import World
from slam import doctor as check_up
from slam import figures, toml_file
from slam.failures import FAILURES
from slam.pipeline import merge_scans
from slam.planning import PLANNERS, PlanningSettings, answer_values, parse_pose, path_text, tour_or_reason
from slam.recordings import open_recording
from slam.result_folder import Source, read_report, report_of, story_of, write_report, write_result
from slam.room_file import free_space
from slam.scoring import map_scores, pose_scores, relation_scores
from slam.settings import Settings, knowing
from slam.simulation.record import Recipe
from slam.simulation.record import simulate as simulate_recording
from slam.story import Story
from slam.whole_output import check_place, whole_folder, write_whole

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False)
out = Console(soft_wrap=True, highlight=False)
err = Console(stderr=True, soft_wrap=True, highlight=False, markup=False)

NO_PATH = 3

PlannerName = Enum("PlannerName", {name: name for name in PLANNERS}, type=str)  # type: ignore[misc]


class Layer(StrEnum):
    """The layers of a map that a robot may be planned on."""

    safety = "safety"
    best = "best"


@app.callback()
def _roomsketch() -> None:
    """From scans to one scored room map, and paths on it."""


@app.command()
def merge(
    recording: Annotated[Path, typer.Argument(help="A recording folder, a CARMEN log or a CSV of ranges.")],
    to: Annotated[Path, typer.Option("--out", help="Folder for map, trajectory, report and figures.")],
    settings: Annotated[Path | None, typer.Option(help="TOML file with what differs from the defaults.")] = None,
    format_name: Annotated[str | None, typer.Option("--format", help="The recording's format, if not guessed.")] = None,
    strict: Annotated[bool, typer.Option(help="Stop at the first damaged line instead of leaving it out.")] = False,
) -> None:
    """Turn a recording into a room map with two planned paths."""
    check_place(to)
    opinions = Settings() if settings is None else toml_file.load(settings, Settings)
    drive = open_recording(recording, format_name, strict=strict)
    opinions = knowing(opinions, drive.odometry_noise)
    merged = merge_scans(_progress(drive.scans), opinions)
    paths, trouble = tour_or_reason(merged.room.safety, merged.estimate.poses[0], opinions.planning)
    report = report_of(merged, drive, Source(recording, format_name), paths) | {"tour": trouble}
    found = {name: answer.path.poses for name, answer in paths.items() if answer.path is not None}
    story = Story(merged.percepts, merged.estimate.poses, merged.room, merged.estimate.landmarks, found)
    with whole_folder(to) as folder:
        write_result(folder, merged, drive, opinions)
        figures.draw(story, folder / "figures")
        write_report(folder, report)
    for damaged in drive.damaged:
        err.print(f"left out or mended: {damaged}")
    _print_values({**report["counts"], **{f"{name} (s)": value for name, value in report["timings"].items()}})
    for name, answer in paths.items():
        out.print(f"{name}: {_told(answer)}")
    if trouble is not None:
        out.print(f"no path planned: {trouble}")
    out.print(f"{to}: map.geojson, trajectory.tum, report.json, settings.toml, figures")


@app.command()
def score(
    result: Annotated[Path, typer.Argument(help="The folder that merge wrote.")],
    truth: Annotated[Path | None, typer.Option(help="GeoJSON plan in the frame of the first pose.")] = None,
    poses: Annotated[Path | None, typer.Option(help="True poses: TUM, or a camera's P lines.")] = None,
    relations: Annotated[
        Path | None, typer.Option(help="Relative poses checked by hand: t1 t2 x y z roll pitch yaw.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> None:
    """Score a map and its trajectory; the scores are also kept in the report."""
    report = read_report(result)
    scores: dict[str, Any] = {"counts": report["counts"]}
    if truth is not None:
        scores |= map_scores(result, truth, poses)
    if poses is not None:
        scores["poses"] = pose_scores(result, poses)
    if relations is not None:
        scores["relations"] = relation_scores(result, relations)
    report["scores"] |= {name: value for name, value in scores.items() if name != "counts"}
    write_report(result, report)
    if as_json:
        print(json.dumps(read_report(result)["scores"] | {"counts": report["counts"]}))
    else:
        _print_values(scores)


@app.command()
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
        out.print(_told(answer))
    if answer.path is None:
        raise typer.Exit(NO_PATH)


@app.command()
def draw(result: Annotated[Path, typer.Argument(help="The folder that merge wrote.")]) -> None:
    """Draw the figures of a result again, from its files and its recording."""
    figures.draw(story_of(result), result / "figures")
    out.print(f"{result / 'figures'}: {', '.join(figures.FIGURES)}")


@app.command()
def simulate(
    plan: Annotated[Path, typer.Argument(help="GeoJSON floor plan in metres, with materials, doors and a drive.")],
    to: Annotated[Path, typer.Option("--out", help="Folder for the recording with its truth.")],
    sensor: Annotated[str, typer.Option(help="sonar_infrared, lidar or time_of_flight.")] = "sonar_infrared",
    seed: Annotated[int, typer.Option(help="Seed of all noise.")] = 0,
    poses: Annotated[Path | None, typer.Option(help="TUM file of true poses, instead of the plan's drive.")] = None,
) -> None:
    """Drive a simulated sensor through a floor plan and record what it reads."""
    simulate_recording(plan, Recipe(sensor, seed), to, poses)
    out.print(f"{to}: recording.toml, readings, truth.geojson, true.tum")


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
    """Run the command line; a failure that is foreseen is one sentence on standard error and exit code 1."""
    try:
        app()
    except FAILURES as failure:
        err.print(f"roomsketch: {' '.join(str(failure).split())}")
        sys.exit(1)


def _progress(scans: tuple[Scan, ...]) -> Iterable[Scan]:
    return track(scans, description="scans", console=err, transient=True, disable=not err.is_terminal)


def _told(answer: Answer) -> str:
    if answer.path is None:
        return f"{answer.kind}: {answer.reason}"
    path = answer.path
    return f"path of {path.length:.3f} m, clearance {path.clearance:.3f} m, {len(path.poses)} poses: {answer.reason}"


def _print_values(values: dict[str, Any]) -> None:
    table = Table("figure", "value", box=None)
    for name, value in _flat(values):
        table.add_row(name, f"{value:.4g}" if isinstance(value, float) else str(value))
    out.print(table)


def _flat(values: dict[str, Any], prefix: str = "") -> Iterable[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}: ")
        else:
            yield f"{prefix}{name}".replace("_", " "), value
