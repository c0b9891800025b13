"""Walls sorted into square cells, so that a straight piece only meets those near its way."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

CELLS_PER_WALL = 4.0  # larger: finer cells, longer to fill


class Raster(NamedTuple):
    """Walls (m, 4) by cells: members from first[column, row], counts[column, row] of them, lie near the cell."""

    ends: Floats
    members: Ints
    first: Ints
    counts: Ints
    left: float
    bottom: float
    cell: float


def raster_of(ends: Floats, bounds: tuple[float, float, float, float], reach: float) -> Raster:
    """Every cell lists the walls within `reach` of any point whose way through the cell is sampled at half a cell."""
    left, bottom, right, top = bounds
    cell = float(np.sqrt((right - left) * (top - bottom) / (CELLS_PER_WALL * len(ends))))
    shape = int((right - left) / cell) + 1, int((top - bottom) / cell) + 1
    frame = np.array([left, bottom, cell, reach + 1.5 * cell])
    counts = _spread(ends, frame, np.zeros(shape, np.int32), np.empty(0, np.int32), np.zeros(shape, np.int32))
    first = (np.cumsum(counts) - counts.ravel()).astype(np.int32).reshape(shape)
    members = np.empty(int(counts.sum()), np.int32)
    _spread(ends, frame, np.zeros(shape, np.int32), members, first)
    return Raster(ends, members, first, counts, left, bottom, cell)


@compiled
def _spread(ends: Floats, frame: Floats, counts: Ints, members: Ints, first: Ints) -> Ints:
    """Count the walls near every cell, and note them in `members` unless it is empty.

    frame: left, bottom, size of a cell, and how near a wall's line must come to a cell's centre.
    """
    left, bottom, cell, near = frame[0], frame[1], frame[2], frame[3]
    for wall in range(ends.shape[0]):
        low_x, high_x = min(ends[wall, 0], ends[wall, 2]) - near, max(ends[wall, 0], ends[wall, 2]) + near
        low_y, high_y = min(ends[wall, 1], ends[wall, 3]) - near, max(ends[wall, 1], ends[wall, 3]) + near
        along_x, along_y = ends[wall, 2] - ends[wall, 0], ends[wall, 3] - ends[wall, 1]
        length = np.hypot(along_x, along_y)
        for column in range(max(0, int((low_x - left) / cell)), min(counts.shape[0], int((high_x - left) / cell) + 1)):
            for row in range(
                max(0, int((low_y - bottom) / cell)), min(counts.shape[1], int((high_y - bottom) / cell) + 1)
            ):
                x, y = left + (column + 0.5) * cell - ends[wall, 0], bottom + (row + 0.5) * cell - ends[wall, 1]
                if abs(along_x * y - along_y * x) <= near * length:
                    if members.size > 0:
                        members[first[column, row] + counts[column, row]] = wall
                    counts[column, row] += 1
    return counts
