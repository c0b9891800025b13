"""Loop closure: which earlier poses the robot may be at again, and how far around them to look.

Doubt grows along the graph: each motion adds its variance, and the doubt of its heading swings everything beyond it.
The way of least doubt from the newest pose to an old one (Dijkstra) says how far off the two may be.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class LoopSettings:
    """Where loops are looked for."""

    ahead: float = 1.5  # metres before the robot where views are compared; larger suits scanners that see far ahead
    near: float = 2.0  # metres between two such points with no doubt at all; larger tries more candidates
    sigmas: float = 3.0  # of doubt that the search covers; larger finds loops after more drift
    widest: float = 6.0  # metres at most; larger searches longer and mistakes more
    apart: int = 12  # poses between two candidates; larger tries fewer
    at_once: int = 2  # candidates tried per pose; larger closes more loops
    skipped: int = 25  # newest poses that are no loop; larger leaves short loops to registration


@dataclass(frozen=True)
class Candidate:
    """An earlier pose (its place in the graph) and the window around it: metres and radians."""

    pose: int
    metres: float
    radians: float


class Drift:
    """The doubt between poses of the graph, as motions and loops are added."""

    def __init__(self) -> None:
        self._ends = np.empty((0, 2), np.int64)
        self._variances = np.empty((0, 2))

    def add(self, fixed: int, moving: int, covariance: Floats) -> None:
        """Two poses are tied with this covariance (3, 3)."""
        variances = np.array([np.trace(covariance[:2, :2]), covariance[2, 2]])
        tied = np.flatnonzero((self._ends == (fixed, moving)).all(axis=1))
        if len(tied):
            self._variances[tied[0]] = np.minimum(self._variances[tied[0]], variances)
            return
        self._ends = np.vstack([self._ends, (fixed, moving)])
        self._variances = np.vstack([self._variances, variances])

    def place_from(self, newest: int, positions: Floats) -> Floats:
        """Standard deviations (n,) in metres of the place of every pose against the newest."""
        lever = np.sum((positions[self._ends[:, 1]] - positions[newest]) ** 2, axis=1)
        return _least_doubt(self._ends, self._variances[:, 0] + self._variances[:, 1] * lever, newest, len(positions))

    def heading_from(self, newest: int, count: int) -> Floats:
        """Standard deviations (n,) in radians of the heading of every pose against the newest."""
        return _least_doubt(self._ends, self._variances[:, 1], newest, count)


def candidates(poses: Floats, drift: Drift, settings: LoopSettings) -> list[Candidate]:
    """Earlier poses that the newest of poses (n, 3) may be looking at again, the nearest first."""
    newest = len(poses) - 1
    if newest < settings.skipped:
        return []
    place = drift.place_from(newest, poses[:, :2])
    ahead = poses[:, :2] + settings.ahead * np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])])
    gaps = np.linalg.norm(ahead - ahead[-1], axis=1)
    doubts = np.minimum(settings.sigmas * place, settings.widest)
    possible = np.flatnonzero((np.arange(newest + 1) < newest - settings.skipped) & (gaps < settings.near + doubts))
    chosen: list[int] = []
    for pose in possible[np.argsort(gaps[possible], kind="stable")]:
        if all(abs(pose - other) > settings.apart for other in chosen):
            chosen.append(int(pose))
        if len(chosen) == settings.at_once:
            break
    if not chosen:
        return []
    heading = drift.heading_from(newest, len(poses))
    return [Candidate(pose, float(doubts[pose]), float(min(settings.sigmas * heading[pose], 0.6))) for pose in chosen]


def _least_doubt(ends: Integers, variances: Floats, newest: int, count: int) -> Floats:
    """Standard deviation (n,) along the way of least variance from the newest pose."""
    graph = csr_matrix((variances, (ends[:, 0], ends[:, 1])), shape=(count, count))
    ways = dijkstra(graph, directed=False, indices=np.array([newest]))
    return np.asarray(np.sqrt(ways[0]), np.float64)
