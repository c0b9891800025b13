"""Which doors and obstacles of the truth the map names, and how well."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from backend.room_map import Door, Obstacle

Floats = NDArray[np.float64]
JAMB = 0.15  # metres both jambs may be off
HALF = 0.5  # of an obstacle's outline, that must be seen before its back can be inferred
NEXT_TO = 0.005  # metres
APART = 0.99  # of its outline borders on free ground: a cupboard against a wall is a piece of the wall
OVERLAP = 0.25  # intersection over union that makes two outlines the same object


@dataclass(frozen=True)
class DoorScores:
    """Doors with both jambs within 15 cm; mean errors of these in metres, nan without any."""

    precision: float
    recall: float
    jamb_error: float
    width_error: float


@dataclass(frozen=True)
class ObstacleScores:
    """Obstacles that overlap a true one by a quarter; nan where there was nothing to find or nothing claimed.

    measured_recall: of the true ones that seen ground encloses. inferred_recall: of these and of those that stand free
    and were seen by half at least, the ones that no measured obstacle explains; a body seen by less has any size.
    """

    measured_precision: float
    measured_recall: float
    inferred_precision: float
    inferred_recall: float
    recall: float


def door_scores(doors: tuple[Door, ...], true_jambs: Floats) -> DoorScores:
    """Doors of the map against true jambs (d, 2, 2), paired one to one."""
    jambs = np.array([door.jambs for door in doors]).reshape(-1, 2, 2)
    straight = np.linalg.norm(jambs[:, None] - true_jambs[None], axis=3)
    crossed = np.linalg.norm(jambs[:, None, ::-1] - true_jambs[None], axis=3)
    errors = np.where((crossed.max(axis=2) < straight.max(axis=2))[..., None], crossed, straight)
    worst = errors.max(axis=2)
    mine, theirs = linear_sum_assignment(np.minimum(worst, 10 * JAMB))
    right = worst[mine, theirs] <= JAMB
    mine, theirs = mine[right], theirs[right]
    widths = np.linalg.norm(jambs[mine, 1] - jambs[mine, 0], axis=1)
    true_widths = np.linalg.norm(true_jambs[theirs, 1] - true_jambs[theirs, 0], axis=1)
    return DoorScores(
        precision=_share(len(mine), len(jambs)),
        recall=_share(len(mine), len(true_jambs)),
        jamb_error=_mean(errors[mine, theirs]),
        width_error=_mean(np.abs(widths - true_widths)),
    )


def obstacle_scores(
    obstacles: tuple[Obstacle, ...], true_obstacles: tuple[Polygon, ...], free: BaseGeometry, seen: BaseGeometry
) -> ObstacleScores:
    """Obstacles of the map against those true ones that stand in free ground apart from the walls, by seen ground."""
    apart = [thing for thing in true_obstacles if _share_seen(thing, free) > APART]
    standing = _within_holes(apart, seen)
    half_seen = [thing for thing in apart if _share_seen(thing, seen) >= HALF]
    hidden = [thing for thing in half_seen if not any(thing is other for other in standing)]
    measured = [thing.outline for thing in obstacles if not thing.inferred]
    inferred = [thing.outline for thing in obstacles if thing.inferred]
    findable = standing + hidden
    by_measured, by_inferred = _matches(measured, findable), _matches(inferred, findable)
    left, enclosed = ~by_measured.any(axis=0), np.arange(len(findable)) < len(standing)
    return ObstacleScores(
        measured_precision=_share(int(_matches(measured, list(true_obstacles)).any(axis=1).sum()), len(measured)),
        measured_recall=_share(int((by_measured.any(axis=0) & enclosed).sum()), len(standing)),
        inferred_precision=_share(int(_matches(inferred, list(true_obstacles)).any(axis=1).sum()), len(inferred)),
        inferred_recall=_share(int((by_inferred.any(axis=0) & left).sum()), int(left.sum())),
        recall=_share(int((by_measured.any(axis=0) | by_inferred.any(axis=0)).sum()), len(findable)),
    )


def _within_holes(things: list[Polygon], ground: BaseGeometry) -> list[Polygon]:
    """The things that ground encloses."""
    islands = [Polygon(ring).buffer(1e-3) for part in shapely.get_parts(ground) for ring in part.interiors]
    return [thing for thing in things if any(thing.within(hole) for hole in islands)]


def _share_seen(thing: Polygon, seen: BaseGeometry) -> float:
    """Which share of a thing's outline borders on seen ground."""
    return float(thing.exterior.intersection(seen.buffer(NEXT_TO)).length / thing.exterior.length)


def _matches(outlines: list[Polygon], true: list[Polygon]) -> NDArray[np.bool_]:
    """Which outlines (m,) overlap which true ones (t,) by a quarter of their union."""
    overlaps = [[one.intersection(other).area / one.union(other).area for other in true] for one in outlines]
    return np.array(overlaps).reshape(len(outlines), len(true)) >= OVERLAP


def _share(part: int, whole: int) -> float:
    return part / whole if whole else float("nan")


def _mean(values: Floats) -> float:
    return float(values.mean()) if values.size else float("nan")
