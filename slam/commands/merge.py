"""`roomsketch merge`: a recording becomes a result folder."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from backend.next_view import NextView
from planners.compiled import compiling
from slam import toml_file
from slam.checkpoint import CheckpointError, Keeper, resumed
from slam.commands.console import err, out, print_values, progress
from slam.commands.planned import announce_compiling, told
from slam.figures import gallery
from slam.html_report import write_page
from slam.logbook import Logbook
from slam.pipeline import Merged, merge_scans
from slam.planning import tour_or_reason
from slam.readers.recording import Recording
from slam.recordings import open_together
from slam.result_folder import Source, folder_for, report_of, write_report, write_result
from slam.settings import Settings, knowing
from slam.story import Story
from slam.whole_output import check_place, whole_folder


def merge(
    recordings: Annotated[
        list[Path],
        typer.Argument(
            metavar="RECORDING",
            help="Recording folders, CARMEN logs, ROS bags or CSVs of ranges; several drives become one map.",
        ),
    ],
    out_folder: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FOLDER", help="Where all goes; here in RECORDING-map if not said."),
    ] = None,
    settings: Annotated[Path | None, typer.Option(help="TOML file with what differs from the defaults.")] = None,
    format_name: Annotated[str | None, typer.Option("--format", help="The recording's format, if not guessed.")] = None,
    strict: Annotated[bool, typer.Option(help="Stop at the first damaged line instead of leaving it out.")] = False,
    every: Annotated[int, typer.Option("--checkpoint-every", min=1, help="Scans between two checkpoints.")] = 200,
) -> None:
    """Turn a recording, or several drives through one building, into a room map with two planned paths.

    A run that was killed goes on from its last checkpoint, FOLDER.checkpoint, when the same command is given again.
    """
    to = out_folder or folder_for(recordings)
    check_place(to)
    opinions = Settings() if settings is None else toml_file.load(settings, Settings)
    drive = open_together(recordings, format_name, strict=strict)
    opinions = knowing(opinions, drive.odometry_noise)
    keeper = _keeper(_checkpoint_of(to), every, drive, opinions)
    with _resumable(keeper, len(drive.scans)):
        merged = merge_scans(progress(drive.scans), opinions, keeper, drive.starts)
        with compiling(announce_compiling):
            paths, trouble = tour_or_reason(merged.room.safety, merged.poses[0], opinions.planning)
        report = report_of(merged, drive, Source(recordings[0], format_name, tuple(recordings[1:])), paths)
        found = {name: answer.path.poses for name, answer in paths.items() if answer.path is not None}
        story = Story(merged.percepts, merged.poses, merged.room, merged.estimate.landmarks, found)
        with whole_folder(to) as folder:
            write_result(folder, merged, drive, opinions)
            gallery.draw(story, folder / "figures")
            write_report(folder, report | {"tour": trouble})
            write_page(folder)
    keeper.path.unlink(missing_ok=True)
    _tell(merged, drive, report)
    for name, answer in paths.items():
        out.print(f"{name}: {told(answer)}")
    if trouble is not None:
        out.print(f"no path planned: {trouble}")
    out.print(f"next best view: {_told_next(story.next_view)}")
    files = "report.html, map.geojson, decisions.geojson, trajectory.tum, graph.g2o, report.json, settings.toml"
    out.print(f"{to}: {files}, figures")


def _tell(merged: Merged, drive: Recording, report: dict[str, Any]) -> None:
    """What was left out, and the figures of the run."""
    for lost in (made for made in merged.estimate.decisions if made.what == "session" and not made.accepted):
        err.print(f"scans {lost.scans[0]} to {lost.scans[-1]}: {lost.reason}")
    for damaged in drive.damaged:
        err.print(f"left out or mended: {damaged}")
    print_values({**report["counts"], **{f"{name} (s)": value for name, value in report["timings"].items()}})


def _told_next(look: NextView | None) -> str:
    if look is None:
        return "none, no frontier is worth a look"
    x, y, heading = look.pose
    return f"x {x:.2f} m, y {y:.2f} m, heading {np.degrees(heading):.0f}°, for {look.gain:.1f} m of frontier"


def _checkpoint_of(to: Path) -> Path:
    """Beside the folder, which itself is only there once it is whole."""
    return to.with_name(f"{to.name}.checkpoint")


def _keeper(path: Path, every: int, drive: Recording, opinions: Settings) -> Keeper:
    """Goes on from the checkpoint at `path` if there is one of this run."""
    if path.exists():
        try:
            keeper = resumed(path, every, drive, opinions)
        except CheckpointError as unfit:
            err.print(f"starting over: {unfit}")
        else:
            err.print(f"going on after scan {keeper.known} of {len(drive.scans)}, from {path}")
            return keeper
    return Keeper(path, every, opinions, Logbook())


@contextmanager
def _resumable(keeper: Keeper, scans: int) -> Iterator[None]:
    """An interruption leaves a checkpoint and says how to go on."""
    try:
        yield
    except KeyboardInterrupt:
        keeper.write()
        done = max(keeper.scans, keeper.known)
        err.print(f"stopped after scan {done} of {scans}: the same command goes on from {keeper.path}")
        raise typer.Exit(130) from None
