"""What a view says of surfaces: its real edges, chain by chain, cut into straight strokes with a facing side.

Chains are runs of real edges. A stroke never crosses a knot: a chain is cut where a straight line no
longer explains it within the view's own spread. Each measured corner gets the normal of its stroke.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from backend.view import EdgeKind, View

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Surfaces:
    """The measured corners of one view's ring, in the robot's frame.

    ring: (m, 2) the boundary of what is surely free, its long real edges cut into pieces; far: (m, 2) the same up to
    the view's bounds, corner by corner; spread: (m,) metres, of its corners along their
    beams; real: (m,) whether edge i to i + 1 is real.
    corner: (n,) which corners of the ring were measured; normals: (n, 2) towards the sensor;
    weight: (n,) metres of surface the corner stands for; sigma: (n,) its standard deviation along the beam, metres;
    sure: (n,) whether the stroke is long enough, against its noise, to have a direction.
    aside: (n,) metres to each side of it that a wide beam leaves the surface.
    """

    ring: Floats
    far: Floats
    spread: Floats
    real: NDArray[np.bool_]
    corner: Ints
    normals: Floats
    weight: Floats
    sigma: Floats
    sure: NDArray[np.bool_]
    aside: Floats


def surfaces_of(view: View, piece: float, finest: float) -> Surfaces:
    """The surfaces of a view; real edges longer than `piece` are cut, no spread is taken below `finest` (metres)."""
    parts = _parts(view, piece)
    far, spread = _cut(view.boundary, parts), np.maximum(_cut(view.spread, parts), finest)
    ring = far if view.wide is None else _cut(view.surely_free, parts)
    real = np.repeat(view.edges == EdgeKind.REAL, parts)
    aside = np.zeros(len(ring)) if view.wide is None else _cut(view.wide.aside, parts)
    starts, lengths = _chains(real)
    stroke, normals, sure = _strokes(np.vstack([ring, ring]), np.concatenate([spread, spread]), starts, lengths)
    corner = np.flatnonzero(stroke >= 0)
    beam = ring[corner] - view.origin
    normals = normals[corner] * -np.sign(np.sum(normals[corner] * beam, axis=1, keepdims=True) + 1e-12)
    edge = np.where(real, np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1), 0.0)
    weight = 0.5 * (edge + np.roll(edge, 1))
    return Surfaces(
        ring, far, spread, real, corner, normals, weight[corner], spread[corner], sure[corner], aside[corner]
    )


def _parts(view: View, piece: float) -> Ints:
    """Into how many parts (m,) each edge of the view is cut: real ones so that none is longer than `piece`."""
    length = np.linalg.norm(np.roll(view.boundary, -1, axis=0) - view.boundary, axis=1)
    return np.where(view.edges == EdgeKind.REAL, np.maximum(np.ceil(length / piece), 1), 1).astype(np.int64)


def _cut(values: Floats, parts: Ints) -> Floats:
    """Values (m, …) of a ring's corners, interpolated along its edges where these are cut into parts (m,)."""
    edge = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(len(edge)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[edge]
    rise = (np.roll(values, -1, axis=0) - values)[edge]
    return np.asarray(values[edge] + (share * rise.T).T)


def _chains(real: NDArray[np.bool_]) -> tuple[Ints, Ints]:
    """First corner and number of corners of every run of real edges around the ring."""
    if real.all():
        return np.zeros(1, dtype=np.int64), np.array([len(real)])
    starts = np.flatnonzero(real & ~np.roll(real, 1))
    ends = np.flatnonzero(~real & np.roll(real, 1))  # the corner where a run stops
    ends = np.where(ends.size and ends[0] <= starts[0], np.roll(ends, -1), ends) if starts.size else ends
    return starts, (ends - starts) % len(real) + 1


@njit(cache=True)
def _strokes(ring, spread, starts, lengths):  # type: ignore[no-untyped-def]
    """Stroke number (−1: none), normal and sureness of every corner of a doubled ring."""
    corners = len(ring) // 2
    stroke = np.full(corners, -1, dtype=np.int64)
    normals = np.zeros((corners, 2))
    sure = np.zeros(corners, dtype=np.bool_)
    stack = np.empty((4 * corners + 4, 2), dtype=np.int64)
    count = 0
    for chain in range(len(starts)):
        stack[0, 0], stack[0, 1] = starts[chain], starts[chain] + lengths[chain] - 1
        depth = 1
        while depth:
            depth -= 1
            first, last = stack[depth]
            points, sigma = ring[first : last + 1], spread[first : last + 1].mean()
            normal, residual, extent = _fit(points)
            if residual > 3.0 * sigma and last - first > 2:
                knot = first + _farthest(points)
                stack[depth, 0], stack[depth, 1] = first, knot
                stack[depth + 1, 0], stack[depth + 1, 1] = knot, last
                depth += 2
                continue
            steady = extent * np.sqrt(last - first + 1) > 24.0 * sigma  # direction known to about 8°
            for i in range(first, last + 1):
                if stroke[i % corners] < 0 or steady:
                    stroke[i % corners], sure[i % corners] = count, steady
                    normals[i % corners] = normal
            count += 1
    return stroke, normals, sure


@njit(cache=True)
def _fit(points):  # type: ignore[no-untyped-def]
    """Total least squares line: its normal, the largest distance of a point from it, the extent along it."""
    middle_x, middle_y = points[:, 0].mean(), points[:, 1].mean()
    x, y = points[:, 0] - middle_x, points[:, 1] - middle_y
    angle = 0.5 * np.arctan2(2 * (x * y).sum(), (x * x).sum() - (y * y).sum())
    across = -np.sin(angle) * x + np.cos(angle) * y
    along = np.cos(angle) * x + np.sin(angle) * y
    return np.array([-np.sin(angle), np.cos(angle)]), np.abs(across).max(), along.max() - along.min()


@njit(cache=True)
def _farthest(points):  # type: ignore[no-untyped-def]
    """The inner point farthest from the chord (or, on a closed chain, from the first point)."""
    chord = points[-1] - points[0]
    length = np.sqrt(chord[0] ** 2 + chord[1] ** 2)
    best, farthest = 1, -1.0
    for i in range(1, len(points) - 1):
        x, y = points[i, 0] - points[0, 0], points[i, 1] - points[0, 1]
        distance = abs(x * chord[1] - y * chord[0]) / length if length > 1e-6 else np.sqrt(x * x + y * y)
        if distance > farthest:
            best, farthest = i, distance
    return best
