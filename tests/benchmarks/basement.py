"""The paper's basement: what the three views give, merged, against what their true poses could see."""

from pathlib import Path
from time import perf_counter
from typing import Any

from shapely import MultiPolygon, Polygon

from slam.pipeline import Merged, merge_scans
from slam.recordings import open_recording
from slam.room_file import free_space
from slam.scores.results import overlap, raw_free_space, visible
from slam.settings import Settings, knowing
from slam.trajectory_file import read_trajectory

FOLDER = Path(__file__).parents[2] / "datasets" / "flynn_basement"
GAIN = 0.15  # in overlap, over the boundaries as the sensor read them
RUNS = 5
Row = dict[str, Any]


def rows() -> list[Row]:
    """Overlap of the merged map beside that of the raw boundaries, and seconds per stage."""
    recording = open_recording(FOLDER)
    scans, settings = recording.scans, knowing(Settings(), recording.odometry_noise)
    merge_scans(scans, settings)  # compiles
    runs, seconds = [], []
    for _ in range(RUNS):
        clock = perf_counter()
        runs.append(merge_scans(scans, settings))
        seconds.append(perf_counter() - clock)
    merged = runs[0]
    free, _ = free_space(FOLDER / "truth.geojson", "free")
    seen = visible(free, read_trajectory(FOLDER / "true.tum").poses, scans[0].sensor.max_range)
    raw = overlap(raw_free_space(scans, merged.estimate.poses), seen)
    overlaps = {"raw sonar boundaries": raw}
    return [
        row(
            "IoU with what the true poses could see",
            overlap(merged.room.free, seen),
            "",
            raw + GAIN,
            overlaps,
            "higher",
        ),
        row("the round obstacle, closed: its IoU", _closed(merged, free), "", 0.25, {}, "higher"),
        row("objects inferred", sum(thing.inferred for thing in merged.room.obstacles), "", 1.0, {}, "lower"),
        row("false free area", merged.room.free.difference(free).area, "m²", None, {}, "lower"),
        row("whole run", min(seconds), "s", None, {}, "lower"),
        *(row(f"stage {stage}", _least(runs, stage), "s", None, {}, "lower") for stage in merged.timings),
    ]


def row(name: str, value: float, unit: str, target: float | None, peers: dict[str, float], better: str) -> Row:
    """One row of the table."""
    return {
        "part": "basement", "name": name, "value": value, "unit": unit, "better": better, "target": target,
        "peers": peers, "runs": RUNS, "note": "three views; the best of the runs",
    }  # fmt: skip


def _closed(merged: Merged, free: MultiPolygon) -> float:
    """The best overlap of an object of the map with the roundest body that stands in the basement."""
    bodies = [Polygon(ring) for part in free.geoms for ring in part.interiors]
    body = max(bodies, key=lambda hole: hole.area / hole.length**2)
    return max((overlap(thing.outline, body) for thing in merged.room.obstacles), default=0.0)


def _least(runs: list[Merged], stage: str) -> float:
    return min(run.timings[stage] for run in runs)
