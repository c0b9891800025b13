"""Where a motion goes beyond the cones: no slice around it keeps the heading that it holds, or no cone covers it."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from planners.path import Cone

Floats = NDArray[np.float64]

CIRCLE = 2 * np.pi
KEPT, LOST, UNCOVERED = 0, 1, 2  # what slices say to a pose: one keeps its heading, none does, none is there
ROUNDING = 1e-9  # radians by which a heading may miss the end of a legal interval


@dataclass(frozen=True, eq=False)
class Beyond:
    """A pose (3,) in the middle of a stretch that no slice allows, and how many slices cover its place.

    Of those slices the one whose legal headings come nearest: its least width, metres, and the headings (2,) that it
    lost around the pose's own, radians; nan where no slice covers the place.
    """

    pose: Floats
    slices: int
    width: float
    lost: Floats


def beyond(cones: tuple[Cone, ...], poses: Floats, step: float, reach: float) -> Beyond | None:
    """The longest stretch of a motion (p, 3) that goes beyond the cones, or None if slices keep it all along.

    Looked at every `step` metres, a radian of turning counts as `reach`. A stretch at the start or the goal, where a
    robot is still on its way to a spine, is named only if there is no other.
    """
    samples = _samples(poses, step, reach)
    sides, legal = _sides(cones), _legal(cones)
    tree = shapely.STRtree([shapely.Polygon(corners) for corners in _quadrilaterals(sides)])
    at, rows = tree.query(shapely.points(samples[:, :2]), predicate="intersects")
    kinds = np.full(len(samples), UNCOVERED)
    kinds[at] = LOST
    kinds[at[_holds(legal[rows], samples[at, 2])]] = KEPT
    if (kinds == KEPT).all():
        return None
    middle = _middle_of_longest(kinds)
    pose, there = samples[middle], rows[at == middle]
    if not len(there):
        return Beyond(pose, 0, np.nan, np.full(2, np.nan))
    below, above = _missing(legal[there], pose[2])
    best = int(np.argmin(np.minimum(below, above)))
    widths = np.linalg.norm(sides[there[best], 0] - sides[there[best], 1], axis=-1)
    return Beyond(pose, len(there), float(widths.min()), pose[2] + np.array([-below[best], above[best]]))


def _samples(poses: Floats, step: float, reach: float) -> Floats:
    """Poses (s, 3) along a motion, ends included."""
    moves = np.diff(poses, axis=0)
    travelled = np.concatenate([[0.0], np.cumsum(np.hypot(moves[:, 0], moves[:, 1]) + reach * np.abs(moves[:, 2]))])
    places = np.linspace(0, travelled[-1], 2 + int(travelled[-1] / step))
    return np.stack([np.interp(places, travelled, poses[:, axis]) for axis in range(3)], axis=1)


def _sides(cones: tuple[Cone, ...]) -> Floats:
    """Both sides of every slice of all cones, each from its begin to its end: (n, 2, 2, 2)."""
    halves = [cone.outline.reshape(2, -1, 2) for cone in cones]
    sides = [np.stack([one.reshape(-1, 2, 2), two[::-1].reshape(-1, 2, 2)], axis=1) for one, two in halves]
    return np.concatenate([np.empty((0, 2, 2, 2)), *sides])


def _quadrilaterals(sides: Floats) -> Floats:
    """Corners (n, 4, 2) in the order of a ring."""
    return np.concatenate([sides[:, 0], sides[:, 1, ::-1]], axis=1)


def _legal(cones: tuple[Cone, ...]) -> Floats:
    """The legal headings (n, k, 2) of every slice of all cones, padded with nan."""
    return np.concatenate([cone.legal for cone in cones]) if cones else np.empty((0, 1, 2))


def _holds(legal: Floats, headings: Floats) -> NDArray[np.bool_]:
    """Whether each of the sets (n, k, 2) holds its heading (n,)."""
    turned = (headings % CIRCLE)[:, None]
    return np.asarray(((legal[..., 0] <= turned + ROUNDING) & (turned <= legal[..., 1] + ROUNDING)).any(axis=1))


def _missing(legal: Floats, heading: float) -> tuple[Floats, Floats]:
    """How far (n,) below and above a heading that none of the sets (n, k, 2) holds their legal ones lie."""
    below, above = (heading - legal[..., 1]) % CIRCLE, (legal[..., 0] - heading) % CIRCLE
    return np.nanmin(below, axis=1), np.nanmin(above, axis=1)


def _middle_of_longest(kinds: NDArray[np.int64]) -> int:
    """The middle of the longest run of one kind beyond the cones; of one at an end of the motion only if all are."""
    begins = np.flatnonzero(np.diff(kinds, prepend=-1))
    stops, kept = np.append(begins[1:], len(kinds)), np.flatnonzero(kinds == KEPT)
    inner = (begins > kept.min(initial=len(kinds))) & (begins < kept.max(initial=-1))
    longest = int(np.argmax((kinds[begins] != KEPT) * (stops - begins + len(kinds) * inner)))
    return int(begins[longest] + stops[longest] - 1) // 2
