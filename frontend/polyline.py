"""The polyline close to every reading along its beam: few vertices, none missed by more than a tolerance."""

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Booleans, Floats, Integers


def bounded_vertices(points: Floats, joined: Booleans, origin: Floats, tolerance: float) -> Integers:
    """Indices (v,) of vertices (n, 2) whose polyline misses no beam from `origin` (2,) by more than the tolerance.

    joined: (n,) whether a vertex and the next lie on one surface; ends of surfaces are always kept.
    """
    kept = ~(joined & np.roll(joined, 1))
    _keep_longest(points - origin, kept, tolerance)
    return np.flatnonzero(kept)


@compiled
def _keep_longest(rays: Floats, kept: Booleans, tolerance: float) -> None:
    """From each kept vertex, the longest chord that stays within the tolerance; its end is kept as well."""
    n = rays.shape[0]
    i = 0
    while i < n - 1:
        best = i + 1
        j = i + 1
        while j < n and not kept[j]:
            if j > i + 1 and _within(rays, i, j, tolerance):
                best = j
            j += 1
        if j < n and kept[j] and _within(rays, i, j, tolerance):
            best = j
        kept[best] = True
        i = best


@compiled
def _within(rays: Floats, i: int, j: int, tolerance: float) -> bool:
    """Whether the chord from ray i to ray j cuts every ray between within the tolerance of its end."""
    dx, dy = rays[j, 0] - rays[i, 0], rays[j, 1] - rays[i, 1]
    top = rays[i, 0] * dy - rays[i, 1] * dx
    for k in range(i + 1, j):
        length = np.hypot(rays[k, 0], rays[k, 1])
        across = rays[k, 0] * dy - rays[k, 1] * dx
        if abs(top * length - length * across) > tolerance * abs(across):
            return False
    return True
