"""Long life: drives that are cut, carried, killed and resumed, and a drone with four beams.

The recordings lie in the folder that ROOMSKETCH_DATA names.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np

from backend.estimate import Estimate
from frontend.rigid_motion import between, compose
from frontend.scan import Scan
from slam.checkpoint import Keeper, resumed
from slam.logbook import Logbook
from slam.mapper import Mapper
from slam.readers.recording import Recording
from slam.recordings import open_recording
from slam.scores.trajectories import Spread, read_relations, relation_errors
from slam.settings import Settings, knowing
from tests.benchmarks.poses import WARM_UP, Row, odometry_of, recordings, row, track_of, wall_gaps

SETTINGS = Settings()


def rows() -> list[Row]:
    """One row per figure. Raises BenchmarkError without the folder of real recordings."""
    folder = recordings()
    intel = folder / "intel" / "intel.log.gz"
    recording = open_recording(intel)
    mapped(recording.scans[:WARM_UP])
    return [
        *session_rows(intel, recording.scans),
        *kidnap_rows(recording.scans),
        *resume_rows(recording),
        *drone_rows(folder / "crazyflie_corridor" / "olsson-demo.csv"),
    ]


def session_rows(path: Path, scans: Sequence[Scan]) -> list[Row]:
    """A log in three drives with unknown starts: are they joined, and how well."""
    third = len(scans) // 3
    clock = process_time()
    _, estimate, slowest = mapped(scans, (third, 2 * third))
    seconds = process_time() - clock
    errors = Spread.of(
        relation_errors(
            track_of(path, scans, estimate.poses), read_relations(path.with_suffix("").with_suffix(".relations"))
        )[0]
    )
    note = f"{len(scans)} scans in 3 drives, {errors.count} relations, also between drives"
    return [
        row("intel in three drives: mean translation error", errors.mean, "m", {}, note) | {"target": 0.025},
        row("intel in three drives: scans left out", int((~estimate.mapped).sum()), "", {}, note) | {"target": 0},
        row("intel in three drives: from log to poses", seconds, "s CPU", {}, note),
        row("intel in three drives: slowest scan", slowest, "s CPU", {}, "searching the other drives' map included"),
    ]


def kidnap_rows(scans: Sequence[Scan]) -> list[Row]:
    """Carried unnoticed from the 300th place to the 361st: the scans after it against those of the undisturbed run."""
    _, whole, _ = mapped(scans)
    start, last = scans[360], scans[299]
    carried = [
        replace(scan, odometry=compose(last.odometry, between(start.odometry, scan.odometry))) for scan in scans[360:]
    ]
    _, estimate, _ = mapped([*scans[:300], *carried])
    undisturbed = np.vstack([whole.poses[:300], whole.poses[360:]])
    apart = np.linalg.norm((estimate.poses - undisturbed)[:, :2], axis=1)[estimate.mapped]
    note = f"{int(estimate.mapped.sum())} of {len(estimate.poses)} scans in the map, against the undisturbed run"
    return [row("intel, carried off: median distance", float(np.median(apart)), "m", {}, note) | {"target": 0.05}]


def resume_rows(recording: Recording) -> list[Row]:
    """A run stopped after nine tenths: what is left to do, as a share of the whole."""
    count = len(recording.scans) * 9 // 10
    with TemporaryDirectory() as folder:
        first = Keeper(Path(folder) / "checkpoint", count, SETTINGS, Logbook())
        whole = timed(recording.scans, first)
        rest = timed(recording.scans, resumed(first.path, count, recording, SETTINGS))
    note = f"stopped after {count} of {len(recording.scans)} scans; the front end is run again, registration is not"
    return [row("intel: time of a resumed run over a whole one", rest / whole, "", {}, note)]


def drone_rows(path: Path) -> list[Row]:
    """Four beams along corridors flown more than once: how far apart the visits see a wall."""
    flight = open_recording(path)
    scans = flight.scans
    mapper, estimate, _ = mapped(scans, settings=knowing(SETTINGS, flight.odometry_noise))
    wheels = replace(estimate, poses=odometry_of(scans))
    closed = sum(made.what == "loop" and made.accepted for made in estimate.decisions)
    gaps, by_odometry = wall_gaps(mapper, estimate), wall_gaps(mapper, wheels)
    note = f"{len(scans)} multi-scans, {closed} loops, {len(gaps)} faces seen again ({len(by_odometry)} by odometry)"
    return [
        row("crazyflie: mean gap between visits of a wall", float(np.mean(gaps)), "m",
            {"odometry alone": float(np.mean(by_odometry))}, note),
        row("crazyflie: faces seen again", len(gaps), "", {"odometry alone": len(by_odometry)}, note)
        | {"better": "higher"},
    ]  # fmt: skip


def mapped(
    scans: Sequence[Scan], starts: Sequence[int] = (), settings: Settings = SETTINGS
) -> tuple[Mapper, Estimate, float]:
    """The mapper after all scans, its estimate, and the CPU seconds of the slowest scan."""
    mapper, slowest = Mapper(settings.frontend, settings.poses), 0.0
    for number, scan in enumerate(scans):
        if number in starts:
            mapper.begin_session("another drive")
        clock = process_time()
        mapper.add(scan)
        slowest = max(slowest, process_time() - clock)
    return mapper, mapper.result(), slowest


def timed(scans: Sequence[Scan], keeper: Keeper) -> float:
    """CPU seconds of a run that keeps a checkpoint."""
    clock = process_time()
    mapper = Mapper(SETTINGS.frontend, SETTINGS.poses, keeper.logbook)
    for scan in scans:
        mapper.add(scan)
        keeper.passed(scan)
    mapper.result()
    return process_time() - clock
