"""Contours of a mask: the rings between inside and outside, back from cells to vectors."""

import numpy as np
import shapely
from numba import njit
from numpy.typing import NDArray
from shapely import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

Floats = NDArray[np.float64]


def contours(mask: NDArray[np.bool_]) -> list[Floats]:
    """Closed rings (r, 2) around the true cells of a mask (rows, columns) whose rim is false.

    Each ring runs through the middles of the cell sides it follows, x along columns and y along rows, in cells,
    with the true cells on its left: outer rings turn counter-clockwise, holes clockwise. Cells that touch
    at a corner only are kept apart.
    """
    sides = _sides(mask)
    rows, columns = np.nonzero(sides)
    length = int(np.bitwise_count(sides[rows, columns]).sum())
    middles, ends = _trace(sides, rows, columns, length)
    return np.split(middles, ends[:-1]) if len(ends) else []


@njit(cache=True)
def _sides(mask):  # type: ignore[no-untyped-def]
    """Which ways a contour leaves every corner of the cells: bits 1, 2, 4, 8 along +x, +y, −x, −y."""
    rows, columns = mask.shape
    sides = np.zeros((rows + 1, columns + 1), dtype=np.uint8)
    for y in range(1, rows - 1):
        for x in range(1, columns - 1):
            if mask[y, x]:
                if not mask[y - 1, x]:
                    sides[y, x] |= 1
                if not mask[y, x + 1]:
                    sides[y, x + 1] |= 2
                if not mask[y + 1, x]:
                    sides[y + 1, x + 1] |= 4
                if not mask[y, x - 1]:
                    sides[y + 1, x] |= 8
    return sides


@njit(cache=True)
def _trace(sides, rows, columns, length):  # type: ignore[no-untyped-def]
    """Follow the sides corner by corner; at a crossing turn left. Gives stacked middles and where each ring ends."""
    step = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
    middles = np.empty((length, 2))
    ends = np.empty(length, dtype=np.int64)
    count = rings = 0
    for seed in range(len(rows)):
        while sides[rows[seed], columns[seed]]:
            x, y = columns[seed], rows[seed]
            heading = 0
            while not sides[y, x] & (1 << heading):
                heading += 1
            while sides[y, x]:
                for turn in (1, 0, 3, 2):
                    if sides[y, x] & (1 << ((heading + turn) % 4)):
                        heading = (heading + turn) % 4
                        break
                sides[y, x] ^= 1 << heading
                middles[count, 0] = x + 0.5 * step[heading, 0]
                middles[count, 1] = y + 0.5 * step[heading, 1]
                x, y = x + step[heading, 0], y + step[heading, 1]
                count += 1
                if x == columns[seed] and y == rows[seed]:
                    break
            ends[rings] = count
            rings += 1
    return middles, ends[:rings]


def assemble(rings: list[Floats]) -> MultiPolygon:
    """Polygons with holes from rings in metres: counter-clockwise ones are outer, clockwise ones are holes."""
    outer = _valid([ring for ring in rings if len(ring) >= 3 and _signed_area(ring) > 0])
    holes = _valid([ring for ring in rings if len(ring) >= 3 and _signed_area(ring) < 0])
    if not outer:
        return MultiPolygon()
    tree = shapely.STRtree(outer)
    areas = shapely.area(outer)
    inside: list[list[Polygon]] = [[] for _ in outer]
    for hole in holes:
        for around in tree.query(hole, predicate="intersects"):
            if areas[around] > hole.area:  # an island in the hole may touch its rim
                inside[int(around)].append(hole)
    whole = [ring.difference(shapely.union_all(cut)) if cut else ring for ring, cut in zip(outer, inside, strict=True)]
    return as_polygons(shapely.union_all(whole))


def as_polygons(shape: BaseGeometry) -> MultiPolygon:
    """Any geometry as polygons, its lines and points left out."""
    return MultiPolygon(_polygons(shape))


def _signed_area(ring: Floats) -> float:
    """Area of a ring, positive if it turns counter-clockwise on the whole: a small crossing does not change that."""
    x, y = (ring - ring[0]).T
    return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _valid(rings: list[Floats]) -> list[Polygon]:
    polygons = np.array([Polygon(ring) for ring in rings], dtype=object)
    crossing = ~shapely.is_valid(polygons)
    polygons[crossing] = shapely.make_valid(polygons[crossing])
    return [part for polygon in polygons for part in _polygons(polygon)]


def _polygons(shape: BaseGeometry) -> list[Polygon]:
    flat = shapely.get_parts(shapely.get_parts(shape))
    return [piece for piece in flat if isinstance(piece, Polygon) and piece.area > 0]
