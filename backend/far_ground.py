"""Far ground: what a view bounds from below but is not sure of, free as far as nothing of the map stands in between.

The arc drawn between two edges of the infrared, or a sonar that heard nothing, says only that the surface is farther
(Flynn 1988, §3.3, rules 2 and 3). What another view measured inside it makes it void from there on; but a wide beam
also answers from beside a gap, so what lies no farther from the gap's side than that beam reaches says nothing.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from backend.evidence import Counts
from backend.samples import Samples

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
DOORWAY = 0.20  # metres to both sides of the line between two jambs in which a wall is the smear of a wide beam


def far_ground(
    origin: Floats, rings: tuple[Floats, Floats], doors: Floats, surface: tuple[Samples, Floats], counts: Counts
) -> NDArray[np.bool_]:
    """Cells (rows, columns) between a view's sure ring and its far one (m, 2) that the others leave free.

    origin: (2,) and doors: (d, 2, 2) of the view; surface: what the others measured, and metres (n,) it may lie aside.
    """
    near, far = rings
    measured, aside = surface
    cleared = np.zeros(counts.free.shape, dtype=np.bool_)
    apart = np.linalg.norm(far - near, axis=1) > 0.5 * counts.cell
    towards = measured.points - origin
    told = (np.sum(measured.normals * towards, axis=1) < 0) & ~_answered_by(measured.points, aside, doors)
    polar = np.column_stack([np.arctan2(towards[:, 1], towards[:, 0]), np.linalg.norm(towards, axis=1)])[told]
    corner = counts.corner * counts.cell
    wall = counts.wall > counts.free
    for gap in _gaps(apart):
        ends = origin + _limits(far[gap] - origin, polar)
        places = ((origin - corner) / counts.cell, (ends - corner) / counts.cell, (doors - corner) / counts.cell)
        _clear(cleared, wall, places, DOORWAY / counts.cell)
    return cleared


def _answered_by(points: Floats, aside: Floats, doors: Floats) -> NDArray[np.bool_]:
    """Whether a wide beam met one of the jambs of the doors (d, 2, 2), and not what lies at the point (n,) itself."""
    jambs = doors.reshape(-1, 2)
    apart = np.linalg.norm(points[:, None] - jambs[None], axis=2)
    return np.asarray((apart <= aside[:, None]).any(axis=1))


def _gaps(apart: NDArray[np.bool_]) -> list[Ints]:
    """Runs of corners that stand apart, each with the corner before and after it; none where all of a ring is bound."""
    corners = len(apart)
    starts = np.flatnonzero(apart & ~np.roll(apart, 1))
    lengths = [int(np.argmin(np.roll(apart, -start))) for start in starts]
    return [(start - 1 + np.arange(n + 2)) % corners for start, n in zip(starts, lengths, strict=True)]


@njit(cache=True)
def _limits(far, polar):  # type: ignore[no-untyped-def]
    """Ends (r, 2) of rays a centimetre apart across the gap, each cut at what was measured (bearing, metres)."""
    first = np.arctan2(far[1, 1], far[1, 0])  # row 0 and the last one are the sides of the gap
    width = (np.arctan2(far[-2, 1], far[-2, 0]) - first) % (2 * np.pi)
    reach = np.sqrt((far**2).sum(axis=1))
    rays = int(width * reach.max() / 0.01) + 2
    ends = np.empty((rays, 2))
    angles = first + width * np.arange(rays) / (rays - 1)
    corner = (np.arctan2(far[1:-1, 1], far[1:-1, 0]) - first) % (2 * np.pi)
    corner[0] = 0.0
    length = np.interp(angles - first, corner, reach[1:-1])
    for bearing, distance in polar:
        inside = (bearing - first) % (2 * np.pi)
        if inside >= width:
            continue
        spread = 0.05 / max(distance, 0.05)  # samples lie up to 10 cm apart on a surface
        low = max(int((inside - spread) / width * (rays - 1)), 0)
        high = min(int((inside + spread) / width * (rays - 1)) + 2, rays)
        for ray in range(low, high):
            length[ray] = min(length[ray], distance)
    for ray in range(rays):
        ends[ray, 0], ends[ray, 1] = length[ray] * np.cos(angles[ray]), length[ray] * np.sin(angles[ray])
    return ends


@njit(cache=True)
def _clear(cleared, wall, places, doorway):  # type: ignore[no-untyped-def]
    """Mark the cells from the origin to the ends (r, 2), up to a wall that stands in none of the doors; in cells."""
    origin, ends, doors = places
    for end in range(len(ends)):
        x, y = ends[end, 0] - origin[0], ends[end, 1] - origin[1]
        steps = int(2 * np.hypot(x, y))
        for step in range(steps):
            px, py = origin[0] + step / steps * x, origin[1] + step / steps * y
            column, row = int(px), int(py)
            if not (0 <= row < wall.shape[0] and 0 <= column < wall.shape[1]):
                break
            if wall[row, column] and not _within(doors, px, py, doorway):
                break
            cleared[row, column] = True


@njit(cache=True)
def _within(doors, x, y, reach):  # type: ignore[no-untyped-def]
    """Whether a point lies within reach of one of the doors' lines, between its jambs."""
    for door in doors:
        ax, ay = door[1, 0] - door[0, 0], door[1, 1] - door[0, 1]
        length = np.hypot(ax, ay) + 1e-9
        along = ((x - door[0, 0]) * ax + (y - door[0, 1]) * ay) / length
        across = abs((x - door[0, 0]) * ay - (y - door[0, 1]) * ax) / length
        if 0 <= along <= length and across <= reach:
            return True
    return False
