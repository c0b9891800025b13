"""Cones to look at: spines with the free strip on both sides, as the slices left it."""

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled
from planners.path import Cone
from planners.slices import Slices

Floats = NDArray[np.float64]


@compiled
def _radii(points: Floats, across: Floats, ends: Floats, most: float) -> Floats:
    """Distance from each of `points` (n, 2) along a unit vector (2,) to the first wall (m, 4), at most `most`."""
    radii = np.full(points.shape[0], most)
    for k in range(points.shape[0]):
        for wall in range(ends.shape[0]):
            x, y = ends[wall, 0] - points[k, 0], ends[wall, 1] - points[k, 1]
            along_x, along_y = ends[wall, 2] - ends[wall, 0], ends[wall, 3] - ends[wall, 1]
            turn = across[0] * along_y - across[1] * along_x
            if turn == 0.0:
                continue
            distance, share = (x * along_y - y * along_x) / turn, (x * across[1] - y * across[0]) / turn
            if distance > 0 and -1e-9 <= share <= 1 + 1e-9:
                radii[k] = min(radii[k], distance)
    return radii


def cone_outlines(slices: Slices, ends: Floats, lines: Floats, pairs: Floats) -> tuple[Cone, ...]:
    """Every cone with its outline: as far as the walls of its pair (k, 2) reach across the spine, or another obstacle.

    ends (m, 4) and lines (m, 3), normals and offsets, of the walls.
    """
    cones = []
    for cone, pair in enumerate(pairs.astype(int)):
        rows = slices.pieces[slices.first[cone] : slices.first[cone + 1]]
        points = np.vstack([rows[:, :2], rows[-1:, 2:]])
        across = lines[pair[0], :2] - lines[pair[1], :2]
        across = across / np.linalg.norm(across)
        left, right = (_side(points, sign * across, ends, lines[each]) for sign, each in ((-1, pair[0]), (1, pair[1])))
        outline = np.vstack([points - left[:, None] * across, (points + right[:, None] * across)[::-1]])
        cones.append(Cone(points[[0, -1]], outline))
    return tuple(cones)


def _side(points: Floats, across: Floats, ends: Floats, line: Floats) -> Floats:
    """Radii (n,) of one side: to the line of its wall, but not through an obstacle."""
    distances = (points @ line[:2] - line[2]) / -(across @ line[:2])
    free = _radii(points, np.ascontiguousarray(across), ends, float(np.ptp(ends)))
    return np.asarray(np.minimum(free, np.maximum(distances, 0)))
