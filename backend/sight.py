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
    view = np.repeat(np.arange(len(rings)), [len(ring) for ring in rings])
    follower = np.arange(1, len(view) + 1)
    ends = np.cumsum([len(ring) for ring in rings])
    follower[ends - 1] = ends - [len(ring) for ring in rings]
    corners = np.concatenate(rings)
    edges = np.stack([corners, corners[follower]], axis=1)
    boxes = np.array([(ring.min(axis=0), ring.max(axis=0)) for ring in rings])
    fans = _fans(edges, view, origins)
    return Sight(origins, np.searchsorted(fans[0], np.arange(len(rings) + 1)), *fans[1:], boxes)


def _fans(edges: Floats, view: Ints, origins: Floats) -> tuple[Ints, Floats, Floats, Floats]:
    """View, bearing, width and ends of the edges (e, 2, 2) around the origins of their views (e,), by bearing.

    Edges that end at their origin span nothing.
    """
    arm = edges - origins[view, None]
    spanning = np.sum(arm**2, axis=2).min(axis=1) > 1e-12
    edges, view, arm = edges[spanning], view[spanning], arm[spanning]
    angle = np.arctan2(arm[:, :, 1], arm[:, :, 0])
    start = angle[np.searchsorted(view, view), 0]  # of the view's first edge
    width = np.mod(angle[:, 1] - angle[:, 0], 2 * np.pi)
    bearing = np.mod(angle[:, 0] - start, 2 * np.pi)
    turning = np.flatnonzero((width > 1e-9) & (width < np.pi))
    order = turning[np.lexsort((bearing[turning], view[turning]))]
    return view[order], (bearing + start)[order], width[order], edges[order]


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
