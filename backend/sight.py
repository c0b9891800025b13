"""Sight: which views hold a point for free, found by bearing in their star-shaped rings."""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Sight:
    """Ring edges of all views, each view's in rising order of bearing.

    origins: (v, 2); first: (v + 1,) where each view's edges begin; bearing: (e,) of an edge's start, counted from
    the view's first edge; width: (e,) bearing the edge spans; edges: (e, 2, 2); boxes: (v, 2, 2) lowest and highest
    x and y of each view's ring.
    """

    origins: Floats
    first: Ints
    bearing: Floats
    width: Floats
    edges: Floats
    boxes: Floats

    def pairs(self, points: Floats) -> tuple[Ints, Ints]:
        """All (point, view) where the point (n, 2) lies in the view's free polygon, by point."""
        rings = (self.first, self.bearing, self.width, self.edges)
        by_x = np.argsort(points[:, 0])
        point, view = _find(points[by_x], self.origins, self.boxes, rings)
        order = np.argsort(by_x[point], kind="stable")
        return by_x[point[order]], view[order]


def sight_of(rings: list[Floats], origins: Floats) -> Sight:
    """The sight of views from their placed counter-clockwise rings (m, 2) and origins (v, 2)."""
    parts = [_fan(ring, origin) for ring, origin in zip(rings, origins, strict=True)]
    first = np.concatenate([[0], np.cumsum([len(bearing) for bearing, _, _ in parts])])
    bearing, width, edges = (np.concatenate([part[i] for part in parts]) for i in range(3))
    boxes = np.array([(ring.min(axis=0), ring.max(axis=0)) for ring in rings])
    return Sight(origins, first, bearing, width, edges, boxes)


def _fan(ring: Floats, origin: Floats) -> tuple[Floats, Floats, Floats]:
    """Bearings, widths and edges of a ring around its origin; edges that end at the origin span nothing."""
    edges = np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)
    edges = edges[np.linalg.norm(edges - origin, axis=2).min(axis=1) > 1e-6]
    angle = np.arctan2(edges[:, :, 1] - origin[1], edges[:, :, 0] - origin[0])
    width = np.mod(angle[:, 1] - angle[:, 0], 2 * np.pi)
    bearing = np.mod(angle[:, 0] - angle[0, 0], 2 * np.pi)
    order = np.argsort(np.where(width < np.pi, bearing, np.inf))[: np.count_nonzero(width < np.pi)]
    absolute = bearing[order] + angle[0, 0]
    return absolute, width[order], edges[order]


@njit(cache=True)
def _find(points, origins, boxes, rings):  # type: ignore[no-untyped-def]
    """All pairs, view by view; points in rising order of x."""
    first, bearing, width, edges = rings
    count = 0
    found = np.empty((2, len(points) + 64), dtype=np.int64)
    for view in range(len(origins)):
        start, end = first[view], first[view + 1]
        low, high = np.searchsorted(points[:, 0], boxes[view, :, 0])
        for point in range(low, high):
            if points[point, 1] < boxes[view, 0, 1] or points[point, 1] > boxes[view, 1, 1]:
                continue
            x, y = points[point, 0] - origins[view, 0], points[point, 1] - origins[view, 1]
            towards = bearing[start] + (np.arctan2(y, x) - bearing[start]) % (2 * np.pi)
            edge = start + np.searchsorted(bearing[start:end], towards, side="right") - 1
            if towards > bearing[edge] + width[edge]:
                continue
            ax, ay = edges[edge, 0]
            bx, by = edges[edge, 1]
            if (bx - ax) * (points[point, 1] - ay) - (by - ay) * (points[point, 0] - ax) > 0:
                if count == found.shape[1]:
                    found = np.concatenate((found, np.empty_like(found)), axis=1)
                found[0, count], found[1, count] = point, view
                count += 1
    return found[0, :count], found[1, :count]
