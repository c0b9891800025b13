"""`roomsketch merge`: a recording becomes a result folder."""

from pathlib import Path
from typing import Annotated

import typer

from slam import figures, toml_file
from slam.commands.console import err, out, print_values, progress
from slam.commands.plan import told
from slam.pipeline import merge_scans
from slam.planning import tour_or_reason
from slam.recordings import open_recording
from slam.result_folder import Source, report_of, write_report, write_result
from slam.settings import Settings, knowing
from slam.story import Story
from slam.whole_output import check_place, whole_folder


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
    merged = merge_scans(progress(drive.scans), opinions)
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
    print_values({**report["counts"], **{f"{name} (s)": value for name, value in report["timings"].items()}})
    for name, answer in paths.items():
        out.print(f"{name}: {told(answer)}")
    if trouble is not None:
        out.print(f"no path planned: {trouble}")
    out.print(f"{to}: map.geojson, trajectory.tum, report.json, settings.toml, figures")
