"""Poses under stress: the Intel building with wheels that lie, beams that fail, and loops that never were.

The recordings lie in the folder that ROOMSKETCH_DATA names. All with the same settings as the undisturbed drive.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from time import process_time

import numpy as np

from backend.estimate import Estimate
from frontend.local_map import Faces
from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from frontend.scan import Booleans, Floats, Integers, Scan
from slam.loops import VerificationSettings, Verify, close_loop
from slam.mapper import Mapper
from slam.perception import Percept
from slam.recordings import open_recording
from slam.scores.trajectories import Spread, read_relations, relation_errors
from slam.settings import Settings
from tests.benchmarks.poses import WARM_UP, Row, mapped, recordings, track_of
from tests.benchmarks.poses import row as figure

STANDS = 0.025  # metres that a stressed drive may be off on average
LONGEST = 120.0  # CPU seconds of one drive
FALSE = 0.2  # false loops for each true one
UNCHANGED = 0.0005  # metres: half a millimetre counts as unchanged
SEED = 1


def rows() -> list[Row]:
    """One row per figure. Raises BenchmarkError without the folder of real recordings."""
    path = recordings() / "intel" / "intel.log.gz"
    scans = open_recording(path).scans
    mapped(scans[:WARM_UP])
    undisturbed = Run(path, scans)
    return [*wheel_rows(undisturbed), *beam_rows(undisturbed), loop_row(undisturbed)]


@dataclass(eq=False)
class Run:
    """A drive through the mapper until it ends or has taken LONGEST."""

    path: Path
    scans: Sequence[Scan]
    verify: Verify = close_loop
    estimate: Estimate = field(init=False)
    seconds: float = field(init=False)

    def __post_init__(self) -> None:
        settings, clock = Settings(), process_time()
        mapper, placed = Mapper(settings.frontend, settings.poses, verify=self.verify), 0
        while placed < len(self.scans) and process_time() - clock < LONGEST:
            mapper.add(self.scans[placed])
            placed += 1
        self.estimate = mapper.result()
        self.seconds = process_time() - clock

    @property
    def error(self) -> float:
        """Mean translation error over the relations in metres; infinite for a drive that took too long."""
        if len(self.estimate.poses) < len(self.scans):
            return float("inf")
        return error_of(self, self.estimate.poses)

    @property
    def said(self) -> str:
        """How far it came, and what it left out."""
        placed, left = len(self.estimate.poses), int((~self.estimate.mapped).sum())
        said = f"{placed} of {len(self.scans)} scans in {self.seconds:.1f} s CPU, {left} of them not in the map"
        if placed < len(self.scans) or not left:
            return said
        inside = Spread.of(errors_of(self, self.estimate.poses)[self.within])
        told = f"mean {inside.mean:.4f} and median {inside.median:.4f} m"
        return f"{said}; the {inside.count} relations within the map: {told}"

    @property
    def within(self) -> Booleans:
        """Which of the relations (r,) lie between scans that stand in the map."""
        times = np.array([scan.time for scan in self.scans])
        after = np.clip(np.searchsorted(times, relations_of(self.path)[:, :2]), 1, len(times) - 1)
        mapped = self.estimate.mapped
        return np.asarray(np.all(mapped[after] & mapped[after - 1], axis=1))


def error_of(run: Run, poses: Floats) -> float:
    """Mean translation error over the relations of other poses (n, 3) for a run's scans."""
    return Spread.of(errors_of(run, poses)).mean


def errors_of(run: Run, poses: Floats) -> Floats:
    """Translation errors (r,) over the relations."""
    return relation_errors(track_of(run.path, run.scans, poses), relations_of(run.path))[0]


def relations_of(path: Path) -> Floats:
    """The relations (r, 5) beside a log."""
    return read_relations(path.with_suffix("").with_suffix(".relations"))


def wheel_rows(undisturbed: Run) -> list[Row]:
    """Wheels a tenth larger than they are said to be, smaller ones, and wheels that count nothing."""
    moves = [between(old.odometry, new.odometry) for old, new in pairwise(undisturbed.scans)]
    found = []
    for name, scale in (("odometry scaled by 1.1", 1.1), ("odometry scaled by 0.9", 0.9), ("frozen wheels", 0.0)):
        claimed = [undisturbed.scans[0].odometry]
        for move in moves:
            claimed.append(compose(claimed[-1], scale * move))
        scans = [replace(scan, odometry=pose) for scan, pose in zip(undisturbed.scans, claimed, strict=True)]
        found.append(stressed(name, Run(undisturbed.path, scans), undisturbed))
    return found


def beam_rows(undisturbed: Run) -> list[Row]:
    """A quarter of the beams without a reading: other ones in every scan, or always those to the right."""
    rng, count = np.random.default_rng(SEED), len(undisturbed.scans[0].ranges)
    lost: dict[str, Callable[[], Integers]] = {
        "a quarter of the beams missing, at random": lambda: rng.permutation(count)[: count // 4],
        "a quarter of the beams missing, on the right": lambda: np.arange(count // 4),
    }
    return [
        stressed(name, Run(undisturbed.path, [without(scan, choose()) for scan in undisturbed.scans]), undisturbed)
        for name, choose in lost.items()
    ]


def without(scan: Scan, lost: Integers) -> Scan:
    """The scan whose readings at these places are unusable."""
    ranges = scan.ranges.copy()
    ranges[lost] = np.nan
    return replace(scan, ranges=ranges)


def loop_row(undisturbed: Run) -> Row:
    """For every five loops that are found, one that was refused is believed, and somewhere else than it was tried."""
    liar = Liar(np.random.default_rng(SEED))
    deceived = Run(undisturbed.path, undisturbed.scans, liar)
    told = stressed(f"{FALSE * 100:.0f} % false loops let in", deceived, undisturbed)
    note = f"{told['note']}; {liar.false} false loops beside {liar.true} true ones, mended on the way"
    return told | {"target": undisturbed.error + UNCHANGED, "note": note}


class Liar:
    """Closes loops as usual, but lets a share of the refused ones in, off by up to the window that was searched."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng, self.true, self.false = rng, 0, 0
        self.last: Alignment | None = None

    def __call__(
        self,
        percept: Percept,
        pose: Floats,
        recent: Faces,
        old: Faces,
        window: tuple[float, float],
        settings: VerificationSettings,
    ) -> Alignment | str:
        """The true answer, or a lie with the confidence of the last true one."""
        answer = close_loop(percept, pose, recent, old, window, settings)
        if not isinstance(answer, str):
            self.true, self.last = self.true + 1, answer
            return answer
        if self.last is None or self.false >= FALSE * self.true:
            return answer
        self.false += 1
        reach = np.maximum(window, (1.0, 0.2))
        return replace(self.last, pose_in_fixed=pose + self.rng.uniform(-1, 1, 3) * reach[[0, 0, 1]])


def stressed(name: str, run: Run, undisturbed: Run) -> Row:
    """The error of a run beside that of the undisturbed one."""
    peers = {"undisturbed": undisturbed.error}
    told = figure(f"intel, {name}: mean translation error", run.error, "m", peers, run.said)
    return told | {"part": "pose_stress", "target": STANDS}
