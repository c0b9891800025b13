"""Poses: how right and how fast drives through real buildings become trajectories.

The recordings lie in the folder that ROOMSKETCH_DATA names. Figures of other systems were measured elsewhere, with the
same relations; they are read from a file beside the recordings.
"""

import gzip
import json
import os
from collections.abc import Sequence
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from backend.estimate import Estimate
from backend.polygon_merging import merge_views
from frontend.local_map import Faces
from frontend.scan import Floats, Scan
from slam.mapper import Mapper
from slam.mapper_settings import MapperSettings
from slam.recordings import open_recording
from slam.scores.results import scaled_to
from slam.scores.trajectories import (
    Spread,
    Track,
    absolute_errors,
    nearest_in_time,
    read_relations,
    relation_errors,
)
from slam.settings import Settings
from tests.benchmarks.pose_costs import peak_megabytes, start_costs
from tests.benchmarks.pose_pieces import ABLATIONS, POORER_SENSORS, spoilt

LOGS = {"intel": "sparse", "intel_dense": "dense"}  # and what the file of the peers calls them
ELSEWHERE = "peers: given figures, measured elsewhere on another machine with the same log and relations"
APART = 60.0  # seconds between two visits of one wall
NEAR = 0.3  # metres between faces of two visits that are taken for one wall
LAGS = np.arange(-6, 7) * 0.05  # seconds that a camera's clock may be off
WARM_UP = 120  # scans: enough to compile every loop and to load what closes loops

Row = dict[str, Any]


class BenchmarkError(Exception):
    """A benchmark that cannot be run; the message says what is missing."""


def recordings() -> Path:
    """The folder of real recordings. Raises BenchmarkError without one."""
    named = os.environ.get("ROOMSKETCH_DATA")
    if named is None:
        raise BenchmarkError("ROOMSKETCH_DATA names no folder of real recordings")
    return Path(named)


def rows() -> list[Row]:
    """One row per figure. Raises BenchmarkError without the folder of real recordings."""
    folder = recordings()
    # First, as a new process begins with the peak memory of the one that started it.
    found = cost_rows(folder / "intel")
    mapped(open_recording(folder / "intel" / "intel.log.gz").scans[:WARM_UP])
    for log in LOGS:
        found += relation_rows(folder, log)
    found += piece_rows(folder / "intel")
    return found + camera_rows(folder / "lego_arena") + closure_rows(folder / "aces" / "aces.log.gz")


def relation_rows(folder: Path, log: str) -> list[Row]:
    """Errors over the relations, the time from log to poses, and where it goes."""
    path = folder / "intel" / f"{log}.log.gz"
    clock = process_time()
    scans = open_recording(path).scans
    mapper, estimate, thirds = mapped_in_thirds(scans)
    seconds = process_time() - clock
    relations = read_relations(folder / "intel" / f"{log}.relations")
    metres, radians = relation_errors(track_of(path, scans, estimate.poses), relations)
    spread, peers = Spread.of(metres), given_peers(folder, log)
    note = f"{spread.count} relations, {len(scans)} scans; {ELSEWHERE}"
    errors = [
        row(f"{log}: {name} translation error", value, "m", peers[key], note)
        for name, key, value in (
            ("mean", "mean", spread.mean),
            ("median", "median", spread.median),
            ("standard deviation of", "std", spread.std),
        )
    ]
    turns = Spread.of(np.degrees(radians))
    shares = np.array(list(mapper.timings.values())) / sum(mapper.timings.values())
    stages = [
        row(f"{log}: {stage}", float(share) * seconds, "s CPU", {}, "its share of the way from log to poses")
        for stage, share in zip(mapper.timings, shares, strict=True)
    ]
    flat = row(f"{log}: time per scan, last third over first", thirds[2] / thirds[0], "", {}, f"{len(scans)} scans")
    return [
        *errors,
        row(f"{log}: mean rotation error", turns.mean, "°", {}, f"{turns.count} relations"),
        row(
            f"{log}: from log to poses",
            seconds,
            "s CPU",
            peers["cpu_s"],
            f"without imports and compilation; {ELSEWHERE}",
        ),
        *stages,
        flat | {"target": 1.5},
    ]


def cost_rows(folder: Path) -> list[Row]:
    """What comes on top of the way from log to poses."""
    imported, compiled = start_costs(folder / "intel.log.gz", WARM_UP)
    megabytes = peak_megabytes(folder / "intel_dense.log.gz")
    return [
        row("imports", imported, "s CPU", {}, "in a fresh process"),
        row("compilation", compiled, "s CPU", {}, "the first time ever; kept on disk for all later runs"),
        row("intel_dense: peak memory", megabytes, "MB", {}, "the whole process") | {"target": 700.0},
    ]


def piece_rows(folder: Path) -> list[Row]:
    """What is left of the rightness on the sparse log where the sensor is poorer or a piece is left out."""
    path, relations = folder / "intel.log.gz", read_relations(folder / "intel.relations")
    scans = open_recording(path).scans

    def mean_error(estimate: Estimate) -> float:
        return Spread.of(relation_errors(track_of(path, scans, estimate.poses), relations)[0]).mean

    found = [
        row(f"intel, {name}: mean translation error", mean_error(mapped(spoilt(scans, spoil))[1]), "m", {}, "")
        | {"target": most}
        for name, spoil, most in POORER_SENSORS
    ]
    for name, settings in ABLATIONS:
        error = mean_error(mapped(scans, settings)[1])
        found.append(row(f"intel, without {name}: mean translation error", error, "m", {}, "what the piece is worth"))
    return found


def camera_rows(folder: Path) -> list[Row]:
    """Absolute error against a camera that watched the robot from above, as it is and with the camera's scale undone.

    What stands nearer to the camera than the floor looks larger: cylinders and robot, though not the walls.
    """
    scans = open_recording(folder).scans
    mapper, estimate = mapped(scans)
    reference = np.array([line.split()[1:4] for line in (folder / "robot4_reference.txt").open()], float) / 1000
    pairs = nearest_in_time(np.array([scan.time for scan in scans]), reference[:, 0], 0.1)
    true = reference[pairs[1], 1:]
    ours, wheels = (poses[pairs[0], :2] for poses in (estimate.poses, odometry_of(scans)))
    note = f"{len(true)} camera positions within 0.1 s of a scan"
    found = []
    for name, scaled in (
        ("rigid alignment", lambda places: places),
        ("and scale", lambda places: scaled_to(places, true)),
    ):
        rmse, by_wheels = (Spread.of(absolute_errors(scaled(places), true)).rmse for places in (ours, wheels))
        found.append(row(f"lego_arena: RMSE against the camera, {name}", rmse, "m", {"wheels alone": by_wheels}, note))
    lagging = [lagging_rmse(scans, estimate.poses, reference, lag) for lag in LAGS]
    best = int(np.argmin(lagging))
    note = f"the camera's clock {LAGS[best]:+.2f} s after the wheels' fits best, as its scale does"
    found.append(row("lego_arena: RMSE against the camera, and its clock", lagging[best], "m", {}, note))
    gap = float(np.mean(view_gaps(mapper, estimate)))
    return [*found, row("lego_arena: mean gap between views of a wall", gap, "m", {}, "no camera is needed for that")]


def lagging_rmse(scans: Sequence[Scan], poses: Floats, reference: Floats, lag: float) -> float:
    """RMSE of poses (n, 3) against a reference (m, 3) = time, x, y of another scale, so many seconds late."""
    times = np.array([scan.time for scan in scans]) + lag
    seen = (times > reference[0, 0]) & (times < reference[-1, 0])
    true = np.column_stack([np.interp(times[seen], reference[:, 0], reference[:, axis]) for axis in (1, 2)])
    return Spread.of(absolute_errors(scaled_to(poses[seen, :2], true), true)).rmse


def closure_rows(path: Path) -> list[Row]:
    """How well corridors close that were driven more than once: no truth is needed for that."""
    scans = open_recording(path).scans
    mapper, estimate = mapped(scans)
    closed = sum(decision.what == "loop" and decision.accepted for decision in estimate.decisions)
    gaps = wall_gaps(mapper, estimate)
    note = (
        f"{len(gaps)} faces seen again after {APART:.0f} s or more, distance across to the other visit's nearest face"
    )
    return [
        row("aces: accepted loops", closed, "", {}, f"of {len(estimate.keyframes)} keyframes") | {"better": "higher"},
        row(
            "aces: mean gap between visits of a wall",
            float(np.mean(gaps)),
            "m",
            {"between views of one visit": float(np.mean(view_gaps(mapper, estimate)))},
            note,
        )
        | {"target": 0.015},
        row("aces: 95 % of the gaps are under", float(np.percentile(gaps, 95)), "m", {}, note),
        alarm_row(mapper, estimate),
        *(gap_row(name, scans, settings) for name, settings in ABLATIONS),
    ]


def alarm_row(mapper: Mapper, estimate: Estimate) -> Row:
    """How many decimetres of measured surface the merged map calls free."""
    room = merge_views([percept.view for percept in mapper.percepts], estimate.poses)
    disagree = sum("poses that disagree" in reason for reason in room.leak_reasons)
    note = f"of {room.free.length:.0f} m of outline; at {disagree} the views disagree in turn"
    return row("aces: wall-leak alarms", len(room.leaks), "", {}, note) | {"target": 0}


def gap_row(name: str, scans: Sequence[Scan], settings: MapperSettings) -> Row:
    """The mean gap with a piece left out."""
    gaps = wall_gaps(*mapped(scans, settings))
    note = f"what the piece is worth; {len(gaps)} faces seen again"
    return row(f"aces, without {name}: mean gap between visits of a wall", float(np.mean(gaps)), "m", {}, note)


def wall_gaps(mapper: Mapper, estimate: Estimate) -> Floats:
    """Distances (g,) across walls between faces of visits at least APART seconds apart, looking the same way."""
    when = np.array([mapper.percepts[scan].scan.time for scan in estimate.keyframes])
    parts = [Faces.placed(mapper.percepts[scan].surface, estimate.poses[scan]) for scan in estimate.keyframes]
    gaps = []
    for seen, time in zip(parts, when, strict=True):
        earlier = [part for part, then in zip(parts, when, strict=True) if then < time - APART]
        if earlier:
            gaps.append(gaps_to(seen, Faces.together(earlier)))
    return np.concatenate(gaps)


def view_gaps(mapper: Mapper, estimate: Estimate) -> Floats:
    """The same (g,) between a keyframe and the dozen before it, which no loop can bring nearer: the sensor's own."""
    parts = [Faces.placed(mapper.percepts[scan].surface, estimate.poses[scan]) for scan in estimate.keyframes]
    return np.concatenate(
        [gaps_to(parts[k], Faces.together(parts[max(0, k - 12) : k - 1])) for k in range(2, len(parts))]
    )


def gaps_to(seen: Faces, earlier: Faces) -> Floats:
    """Distances (g,) across from each face to the nearest earlier one that looks the same way, where one is near."""
    # A unit of normal counts as a metre, so a face that is turned by 17° or more is too far off to be a partner.
    tree = cKDTree(np.hstack([earlier.points, earlier.normals]))
    partners = np.asarray(tree.query(np.hstack([seen.points, seen.normals]), distance_upper_bound=NEAR)[1])
    found = partners < len(earlier.points)
    offsets = seen.points[found] - earlier.points[partners[found]]
    return np.asarray(np.abs(np.sum(offsets * earlier.normals[partners[found]], axis=1)))


def mapped(scans: Sequence[Scan], poses: MapperSettings | None = None) -> tuple[Mapper, Estimate]:
    """The mapper after all scans, and its estimate."""
    settings = Settings()
    mapper = Mapper(settings.frontend, poses or settings.poses)
    for scan in scans:
        mapper.add(scan)
    return mapper, mapper.result()


def mapped_in_thirds(scans: Sequence[Scan]) -> tuple[Mapper, Estimate, Floats]:
    """The same, and the CPU seconds (3,) that each third of the scans took as they came."""
    settings, clocks = Settings(), [process_time()]
    mapper = Mapper(settings.frontend, settings.poses)
    for third in range(3):
        for scan in scans[third * len(scans) // 3 : (third + 1) * len(scans) // 3]:
            mapper.add(scan)
        clocks.append(process_time())
    return mapper, mapper.result(), np.diff(clocks)


def track_of(path: Path, scans: Sequence[Scan], poses: Floats) -> Track:
    """Poses of the scans, joined by every odometry line of a CARMEN log."""
    with gzip.open(path, "rt") as lines:
        wheels = np.array([words[1:4] + words[-3:-2] for words in map(str.split, lines) if words[0] == "ODOM"], float)
    return Track(np.array([scan.time for scan in scans]), poses, wheels[:, 3], wheels[:, :3])


def odometry_of(scans: Sequence[Scan]) -> Floats:
    """Raw odometry (n, 3) of the scans."""
    return np.array([scan.odometry for scan in scans])


def given_peers(folder: Path, log: str) -> dict[str, dict[str, float]]:
    """Figures of other systems by figure and name, as they stand in the file beside the recordings."""
    path = folder.parent / "benchmarks" / "peers_intel.json"
    if not path.exists():
        raise BenchmarkError(f"{path} is missing: the figures of other systems stand in it")
    systems = json.loads(path.read_text())[LOGS[log]]["systems"]
    return {
        key: {name: figures[key] for name, figures in systems.items()} for key in ("mean", "median", "std", "cpu_s")
    }


def row(name: str, value: float, unit: str, peers: dict[str, float], note: str) -> Row:
    """A figure where less is better; the target is the best of the peers, where there are any."""
    target = min(peers.values(), default=None)
    return {
        "part": "poses", "name": name, "value": value, "unit": unit, "better": "lower",
        "target": target, "peers": peers, "runs": 1, "note": note,
    }  # fmt: skip
