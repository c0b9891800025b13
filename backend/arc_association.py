"""Association of arcs with walls and edges already on the map: the surest first, each moving what is believed.

Pose and landmarks are believed together, with their full joint covariance: what was seen a moment ago is known sharply
from here, what was seen before a round trip only as far as the round trip was known, so revisits need no search of
their own. An arc that two landmarks explain alike ties nothing (joint, not individual, compatibility: Neira & Tardós
2001).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from backend.arcs import Arcs, seen_edge, seen_wall, wrapped

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class AssociationSettings:
    """When an arc is a landmark seen again."""

    gate: float = 9.2  # squared Mahalanobis distance (χ², 2 degrees of freedom, 1 %); larger matches farther off
    rival: float = 3.0  # by which the second best must be worse, in the same measure; larger refuses more doubtful ones
    apart: float = 0.3  # metres a wall may go on beyond what was seen of it; larger joins walls across gaps
    facing: float = np.radians(60.0)  # between rays that meet one edge; larger pools both corners of a wall's end
    coarse: float = 0.8  # radians and metres beyond which nothing is compared; larger only costs time


class Known(NamedTuple):
    """A landmark in the belief: whether a wall, where its values start in it, what is known of a wall's extent, and the
    heading of the ray that first met an edge."""

    wall: bool
    slot: int
    start: float
    stop: float
    ray: float


@dataclass(frozen=True, eq=False)
class Belief:
    """Mean (d,) and covariance (d, d) of a pose (the first three values) and of landmarks."""

    mean: Floats
    covariance: Floats

    def updated(self, columns: Integers, slope: Floats, innovation: Floats, variance: Floats) -> "Belief":
        """After a measurement of some columns (c,): its slope (m, c), innovation (m,) and own covariance (m, m)."""
        across = self.covariance[:, columns] @ slope.T
        gain = across @ np.linalg.inv(slope @ across[columns] + variance)
        return Belief(self.mean + gain @ innovation, self.covariance - gain @ across.T)


@dataclass(frozen=True, eq=False)
class Placement:
    """Pose (3,) and covariance (3, 3) in the room's axes after association. pairs: arc and landmark, and how far
    leftward of a wall's origin its foot lies; loose: arcs that no landmark explains."""

    pose: Floats
    covariance: Floats
    pairs: tuple[tuple[int, int], ...]
    loose: tuple[int, ...]


class _Option(NamedTuple):
    """A landmark that may explain an arc; cost: squared distance and how vague it is."""

    cost: float
    landmark: int
    columns: Integers
    slope: Floats
    innovation: Floats
    variance: Floats
    vagueness: float


def associate(belief: Belief, known: list[Known], arcs: Arcs, settings: AssociationSettings) -> Placement:
    """Match arcs one to one with the landmarks of the belief."""
    loose, taken, pairs = list(range(len(arcs.ranges))), set[int](), []
    while True:
        options = {k: found for k in loose for found in [_options(belief, known, arcs, k, taken, settings)] if found}
        if not options:
            break
        arc = max(options, key=lambda k: (min(_margin(options[k]), 2 * settings.rival), -options[k][0].vagueness))
        loose.remove(arc)
        best = options[arc][0]
        if _margin(options[arc]) >= settings.rival:
            taken.add(best.landmark)
            pairs.append((arc, best.landmark))
            belief = belief.updated(best.columns, best.slope, best.innovation, best.variance)
    pose = belief.mean[:3].copy()
    pose[2] = wrapped(pose[2])
    return Placement(pose, belief.covariance[:3, :3], tuple(pairs), tuple(loose))


def _margin(options: list[_Option]) -> float:
    return options[1].cost - options[0].cost if len(options) > 1 else np.inf


def _options(
    belief: Belief, known: list[Known], arcs: Arcs, arc: int, taken: set[int], settings: AssociationSettings
) -> list[_Option]:
    """What may explain an arc, the best first."""
    options = [
        option
        for landmark, one in enumerate(known)
        if landmark not in taken
        for option in [_compared(belief, one, arcs, arc, landmark, settings)]
        if option is not None
    ]
    return sorted(options, key=lambda option: option.cost)


def _compared(
    belief: Belief, one: Known, arcs: Arcs, arc: int, landmark: int, settings: AssociationSettings
) -> _Option | None:
    pose, there = belief.mean[:3], belief.mean[one.slot : one.slot + (3 if one.wall else 2)]
    if one.wall:
        seen, slope, along = seen_wall(pose, there)
        measured, variances = arcs.as_wall(arc)
        # What may be an edge as well is a wall only where a wall was seen: by its end it would be taken for one.
        start, stop = (arcs.starts[arc], arcs.stops[arc]) if arcs.firm[arc] else (0.0, 0.0)
        if along + start > one.stop + settings.apart or along + stop < one.start - settings.apart:
            return None
    else:
        seen, slope = seen_edge(pose, there)
        measured, variances = arcs.as_edge(arc)
        if abs(wrapped(pose[2] + seen[1] - one.ray)) > settings.facing:
            return None
    innovation = np.array([measured[0] - seen[0], wrapped(measured[1] - seen[1])])
    if np.abs(innovation).max() > settings.coarse:
        return None
    columns = np.concatenate([np.arange(3), one.slot + np.arange(len(there))])
    spread = slope @ belief.covariance[np.ix_(columns, columns)] @ slope.T + np.diag(variances)
    distance = float(innovation @ np.linalg.solve(spread, innovation))
    if distance > settings.gate:
        return None
    vagueness = float(np.log(np.linalg.det(spread)))
    return _Option(distance + vagueness, landmark, columns, slope, innovation, np.diag(variances), vagueness)
