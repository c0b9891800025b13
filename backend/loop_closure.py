"""Loop closure: which earlier poses the robot may be at again, and how far around them to look.

Doubt grows along the graph: each motion adds its variance, and the doubt of its heading swings everything beyond it.
The way of least doubt from the newest pose to an old one (Dijkstra) says how far off the two may be.
"""

import heapq
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class LoopSettings:
    """Where loops are looked for."""

    ahead: float = 1.5  # metres before the robot where views are compared; larger suits scanners that see far ahead
    near: float = 2.0  # metres between two such points with no doubt at all; larger tries more candidates
    sigmas: float = 3.0  # of doubt that the search covers; larger finds loops after more drift
    widest: float = 6.0  # metres at most; larger searches longer and mistakes more
    turned: float = 0.6  # radians at most; larger does the same
    confirmed: float = 3.0  # metres between two views that confirm a doubted loop; larger asks for more new surface
    apart: int = 12  # poses between two candidates; larger tries fewer
    at_once: int = 2  # candidates tried per pose; larger closes more loops
    skipped: int = 25  # newest poses that are no loop; larger leaves short loops to registration


@dataclass(frozen=True)
class Candidate:
    """An earlier pose (its place in the graph) and the window around it: metres and radians.

    covered: whether the newest pose must be in there, for all that is known.
    """

    pose: int
    metres: float
    radians: float
    covered: bool = True


class Drift:
    """The doubt between poses of the graph, as motions and loops are added."""

    def __init__(self) -> None:
        self._rows: dict[tuple[int, int], int] = {}
        self._ends = np.empty((64, 2), np.int64)  # room for more than there are, so that adding copies nothing
        self._variances = np.empty((64, 2))

    def add(self, fixed: int, moving: int, covariance: Floats) -> None:
        """Two poses are tied with this covariance (3, 3)."""
        variances = np.array([covariance[0, 0] + covariance[1, 1], covariance[2, 2]])
        if (row := self._rows.get((fixed, moving))) is not None:
            self._variances[row] = np.minimum(self._variances[row], variances)
            return
        row = self._rows[fixed, moving] = len(self._rows)
        if row == len(self._ends):
            self._ends = np.concatenate([self._ends, np.empty_like(self._ends)])
            self._variances = np.concatenate([self._variances, np.empty_like(self._variances)])
        self._ends[row], self._variances[row] = (fixed, moving), variances

    def of_submap(self, middle: int, beside: int) -> Floats:
        """(3, 3) covariance of a submap against its middle pose: of so many poses to either side, taken together.

        The poses of a side walk at random away from the middle one: the sum of n of them errs by 1² + 2² + … + n²
        steps' variances.
        """
        ends = (range(middle - beside, middle), range(middle, middle + beside))
        sides = [[row for k in side if (row := self._rows.get((k, k + 1))) is not None] for side in ends]
        counts = np.array([len(side) for side in sides])
        if not counts.any():
            return np.zeros((3, 3))
        summed = np.sum(counts * (counts + 1) * (2 * counts + 1) / 6)
        place, heading = summed / (1 + counts.sum()) ** 2 * self._variances[sides[0] + sides[1]].mean(axis=0)
        return np.diag([place / 2, place / 2, heading])

    def place_from(self, newest: int, positions: Floats) -> Floats:
        """Standard deviations (n,) in metres of the place of every pose against the newest."""
        ends, variances = self._ends[: len(self._rows)], self._variances[: len(self._rows)]
        lever = np.sum((positions[ends[:, 1]] - positions[newest]) ** 2, axis=1)
        return np.asarray(np.sqrt(least_sums(ends, variances[:, 0] + variances[:, 1] * lever, newest, len(positions))))

    def heading_from(self, newest: int, count: int) -> Floats:
        """Standard deviations (n,) in radians of the heading of every pose against the newest."""
        ends, variances = self._ends[: len(self._rows)], self._variances[: len(self._rows)]
        return np.asarray(np.sqrt(least_sums(ends, variances[:, 1].copy(), newest, count)))


@dataclass(frozen=True, eq=False)
class Outlook:
    """What the newest pose may be looking at again: all earlier poses, by what is known of the way between them.

    gaps: (n,) metres between what each looks at and what the newest does. doubts: (n,) metres that this may be wrong
    by. earlier: (n,) whether a pose is old enough for a loop.
    """

    gaps: Floats
    doubts: Floats
    earlier: NDArray[np.bool_]


def outlook(poses: Floats, drift: Drift, settings: LoopSettings) -> Outlook:
    """Of the newest of poses (n, 3), at least one."""
    newest = len(poses) - 1
    ahead = poses[:, :2] + settings.ahead * np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])])
    gaps = np.linalg.norm(ahead - ahead[-1], axis=1)
    doubts = settings.sigmas * drift.place_from(newest, poses[:, :2])
    return Outlook(gaps, doubts, np.arange(newest + 1) < newest - settings.skipped)


def candidates(seen: Outlook, drift: Drift, settings: LoopSettings) -> list[Candidate]:
    """Earlier poses around which the newest can be searched for, the nearest first."""
    count = len(seen.gaps)
    doubts = np.minimum(seen.doubts, settings.widest)
    possible = np.flatnonzero(seen.earlier & (seen.gaps < settings.near + doubts))
    chosen: list[int] = []
    for pose in possible[np.argsort(seen.gaps[possible], kind="stable")]:
        if all(abs(pose - other) > settings.apart for other in chosen):
            chosen.append(int(pose))
        if len(chosen) == settings.at_once:
            break
    if not chosen:
        return []
    heading = settings.sigmas * drift.heading_from(count - 1, count)
    return [
        Candidate(
            pose,
            float(doubts[pose]),
            float(min(heading[pose], settings.turned)),
            bool(seen.doubts[pose] <= settings.widest and heading[pose] <= settings.turned),
        )
        for pose in chosen
    ]


def beyond_search(seen: Outlook, drift: Drift, settings: LoopSettings) -> list[Candidate]:
    """Earlier poses that the newest may be looking at again although no search reaches as far as their doubt."""
    count = len(seen.gaps)
    reached = np.isfinite(seen.doubts) & seen.earlier & (seen.gaps < settings.near + seen.doubts)
    far = np.flatnonzero(reached & (seen.doubts > settings.widest))
    if not len(far):
        return []
    heading = np.minimum(settings.sigmas * drift.heading_from(count - 1, count), np.pi)
    return [Candidate(int(pose), float(seen.doubts[pose]), float(heading[pose]), covered=False) for pose in far]


@njit(cache=True)  # type: ignore[untyped-decorator]
def least_sums(ends: Integers, costs: Floats, start: int, count: int) -> Floats:
    """The least sum (count,) of costs (m,) along ties (m, 2), walked either way, from the start; Dijkstra 1959."""
    first = np.zeros(count + 2, np.int64)
    for k in range(len(ends)):
        first[ends[k, 0] + 2] += 1
        first[ends[k, 1] + 2] += 1
    first = np.cumsum(first)
    beyond, cost = np.empty(2 * len(ends), np.int64), np.empty(2 * len(ends))
    for k in range(len(ends)):
        for side in range(2):
            slot = first[ends[k, side] + 1]
            beyond[slot], cost[slot] = ends[k, 1 - side], costs[k]
            first[ends[k, side] + 1] += 1
    sums = np.full(count, np.inf)
    sums[start] = 0.0
    queue = [(0.0, start)]
    while queue:
        total, here = heapq.heappop(queue)
        if total > sums[here]:
            continue
        for slot in range(first[here], first[here + 1]):
            there, farther = beyond[slot], total + cost[slot]
            if farther < sums[there]:
                sums[there] = farther
                heapq.heappush(queue, (farther, there))
    return sums
