"""Face cells: the surface of all poses by place and facing side, and the line that the points of each cell lie on.

Points of a thin wall's two faces, or of two walls that meet in a corner, look to different sides and share no cell.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from backend.cell_lines import in_groups, numbered

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Sheaf:
    """Surface of all poses in their own frames.

    points (n, 2), normals (n, 2), spread (n,) metres across the surface, owner (n,) index of the pose.
    """

    points: Floats
    normals: Floats
    spread: Floats
    owner: Integers

    def in_order(self) -> "Sheaf":
        """The same surface, pose by pose."""
        order = np.argsort(self.owner, kind="stable")
        return Sheaf(self.points[order], self.normals[order], self.spread[order], self.owner[order])


@dataclass(frozen=True, eq=False)
class Cells:
    """Points cell by cell, those of a cell in order of their poses.

    points, normals: (n, 2) in the room's frame. spread, owner: (n,) as in the sheaf. starts: (c + 1,) where each cell's
    points begin. squares: (c, 3) column, row and sector of each.
    """

    points: Floats
    normals: Floats
    spread: Floats
    owner: Integers
    starts: Integers
    squares: Integers


def into_cells(sheaf: Sheaf, poses: Floats, size: float, shift: Floats, sectors: int) -> Cells:
    """The surface placed at poses (k, 3) and cut into squares of `size` metres and facing sectors.

    shift: (2,) how far the grid is moved, as a share of a square; the sectors are turned by the first share of one.
    """
    points, normals, squares = _placed(sheaf.points, sheaf.normals, sheaf.owner, poses, size, shift, sectors)
    numbers, known = in_squares(squares, sectors)
    order, starts = in_groups(numbers, len(known))
    return Cells(points[order], normals[order], sheaf.spread[order], sheaf.owner[order], starts, known)


def in_squares(squares: Integers, sectors: int) -> tuple[Integers, Integers]:
    """The number (n,) of each column, row and sector (n, 3), and those that there are (c, 3)."""
    lowest = squares.min(axis=0)
    rows = squares[:, 1].max() - lowest[1] + 1
    codes = ((squares[:, 0] - lowest[0]) * rows + squares[:, 1] - lowest[1]) * sectors + squares[:, 2]
    numbers, known = numbered(codes)
    columns, row = np.divmod(known // sectors, rows)
    return numbers, np.column_stack([columns + lowest[0], row + lowest[1], known % sectors])


@njit(cache=True)  # type: ignore[untyped-decorator]
def _placed(
    points: Floats, normals: Floats, owner: Integers, poses: Floats, size: float, shift: Floats, sectors: int
) -> tuple[Floats, Floats, Integers]:
    """Points and normals (n, 2) in the room's frame, and the column, row and sector (n, 3) of each."""
    placed, turned = np.empty_like(points), np.empty_like(normals)
    squares = np.empty((len(points), 3), np.int64)
    cosines, sines = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    for i in range(len(points)):
        k = owner[i]
        c, s = cosines[k], sines[k]
        placed[i, 0] = c * points[i, 0] - s * points[i, 1] + poses[k, 0]
        placed[i, 1] = s * points[i, 0] + c * points[i, 1] + poses[k, 1]
        turned[i, 0] = c * normals[i, 0] - s * normals[i, 1]
        turned[i, 1] = s * normals[i, 0] + c * normals[i, 1]
        for axis in range(2):
            squares[i, axis] = int(np.floor(placed[i, axis] / size + shift[axis]))
        facing = np.arctan2(turned[i, 1], turned[i, 0]) / (2 * np.pi) + shift[0]
        squares[i, 2] = int(np.floor(facing * sectors)) % sectors
    return placed, turned, squares


@dataclass(frozen=True, eq=False)
class Lines:
    """One line per cell: centres (c, 2), normals (c, 2), kept (c,) whether enough poses agree on it.

    across, along: (c,) variances of its points, weight: (c,) how many they count for.
    """

    centres: Floats
    normals: Floats
    kept: NDArray[np.bool_]
    across: Floats
    along: Floats
    weight: Floats


@dataclass(frozen=True)
class LineRules:
    """What makes the points of a cell a line.

    views: poses at least. width, thickest: metres of the Cauchy width and of the scatter across, or twice the spread.
    cosine: between the line's normal and the mean facing side, at least.
    """

    views: int
    width: float
    thickest: float
    cosine: float


def lines_of(cells: Cells, rules: LineRules) -> Lines:
    """Total least squares in each cell, twice: the second time without the outliers of the first."""
    fits, views, spread, facing = _fitted(
        cells.points, cells.normals, cells.spread, cells.owner, cells.starts, rules.width
    )
    normals, across, along = fits[:, 2:4], fits[:, 4], fits[:, 5]
    agree = np.abs(np.sum(facing * normals, axis=1)) > rules.cosine * np.linalg.norm(facing, axis=1)
    thin = (np.sqrt(across) < np.maximum(rules.thickest, 2 * spread)) & (along > 4 * across)
    return Lines(fits[:, :2], normals, (views >= rules.views) & thin & agree, across, along, fits[:, 6])


@njit(cache=True)  # type: ignore[untyped-decorator]
def _fitted(
    points: Floats, normals: Floats, spread: Floats, owner: Integers, starts: Integers, width: float
) -> tuple[Floats, Integers, Floats, Floats]:
    """Fits (c, 7) of lines; how many poses (c,), the mean spread (c,) and summed normals (c, 2) of their points."""
    count = len(starts) - 1
    fits, views = np.empty((count, 7)), np.zeros(count, np.int64)
    mean_spread, facing = np.zeros(count), np.zeros((count, 2))
    for cell in range(count):
        first, last = starts[cell], starts[cell + 1]
        for i in range(first, last):
            views[cell] += i == first or owner[i] != owner[i - 1]
            mean_spread[cell] += spread[i] / (last - first)
            for axis in range(2):
                facing[cell, axis] += normals[i, axis]
        fits[cell] = _line(points, spread, first, last, np.inf, fits[cell])
        fits[cell] = _line(points, spread, first, last, width, fits[cell])
    return fits, views, mean_spread, facing


@njit(cache=True)  # type: ignore[untyped-decorator]
def _line(points: Floats, spread: Floats, first: int, last: int, width: float, before: Floats) -> Floats:
    """Centre, normal, variances across and along, weight (7,) of points first…last, by their distance from a line."""
    total, x, y = 1e-12, 0.0, 0.0
    weights = np.ones(last - first)
    for i in range(first, last):
        if width < np.inf:
            off = (points[i, 0] - before[0]) * before[2] + (points[i, 1] - before[1]) * before[3]
            weights[i - first] = 1 / (1 + (off / max(width, 2 * spread[i])) ** 2)
        total += weights[i - first]
        x += weights[i - first] * points[i, 0]
        y += weights[i - first] * points[i, 1]
    x, y = x / total, y / total
    xx, xy, yy = 0.0, 0.0, 0.0
    for i in range(first, last):
        dx, dy = points[i, 0] - x, points[i, 1] - y
        xx += weights[i - first] * dx * dx / total
        xy += weights[i - first] * dx * dy / total
        yy += weights[i - first] * dy * dy / total
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    across = 0.5 * (xx + yy) - np.sqrt((0.5 * (xx - yy)) ** 2 + xy * xy)
    return np.array([x, y, -np.sin(angle), np.cos(angle), max(across, 0.0), xx + yy - across, total])
