"""Maximum-likelihood polylines of a scan, after Schaefer, Büscher, Luft & Burgard (2018): greedy, then moved freely.

The greedy step is compiled like the product's own search; the vertices are moved by scipy's least squares.
"""

import numpy as np
from scipy.optimize import least_squares

from frontend.best_polylines import Polylines
from frontend.compiled import compiled
from frontend.scan import Booleans, Floats, Integers
from tests.benchmarks.polylines import misses, runs_of

UNDRAWN = 0.5  # metres that a ray without a line counts for, as in the published experiments


def maximum_likelihood(rays: Floats, joined: Booleans, count: int) -> Polylines:
    """The readings of the greedy step, then moved to the best likelihood (Gaussian along the ray), line by line."""
    lines = most_likely_readings(rays, joined, count)
    moved = lines.vertices.copy()
    for first, last in runs_of(lines.joined):
        moved[first : last + 1] = _moved(rays[lines.rays[first] : lines.rays[last] + 1], moved[first : last + 1])
    return Polylines(moved, lines.rays, lines.joined)


def _moved(rays: Floats, start: Floats) -> Floats:
    """Vertices (v, 2) at the best likelihood: the ends slide along their rays, the others move freely."""
    bearings, lengths = np.unwrap(np.arctan2(start[:, 1], start[:, 0])), np.hypot(start[:, 0], start[:, 1])
    v = lengths.size

    def placed(free: Floats) -> Floats:
        turned = np.concatenate([bearings[:1], free[v:], bearings[-1:]])
        return np.asarray(free[:v, None] * np.column_stack([np.cos(turned), np.sin(turned)]))

    def errors(free: Floats) -> Floats:
        turned = np.concatenate([bearings[:1], free[v:], bearings[-1:]])
        ordered = bool(np.all(np.diff(turned) > 0))
        return misses(rays, placed(free)) if ordered else np.full(rays.shape[0], 1e3)

    first = np.concatenate([lengths, bearings[1:-1]])
    scales = np.concatenate([np.full(v, 0.1), np.full(v - 2, 0.01)])
    found = least_squares(errors, first, max_nfev=15, x_scale=scales)
    return placed(found.x if found.cost < 0.5 * np.sum(errors(first) ** 2) else first)


def most_likely_readings(rays: Floats, joined: Booleans, count: int) -> Polylines:
    """The readings that the greedy step leaves, before they are moved."""
    before, after = remove_least_likely(rays, joined, count, UNDRAWN**2)
    kept = np.flatnonzero((before >= 0) | (after >= 0))
    return Polylines(rays[kept], kept, after[kept] >= 0)


@compiled
def remove_least_likely(rays: Floats, joined: Booleans, count: int, undrawn: float) -> tuple[Integers, Integers]:
    """The vertex before and after each ray (n,), −1 for none, once so many are left of all that a line joins."""
    n = rays.shape[0]
    before, after = np.full(n, -1), np.full(n, -1)
    for k in range(n - 1):
        if joined[k]:
            after[k], before[k + 1] = k + 1, k
    loss = np.array([_loss(rays, before, after, k, undrawn) for k in range(n)])
    left = np.sum(np.isfinite(loss))
    while left > count:
        k = int(np.argmin(loss))
        i, j = before[k], after[k]
        before[k] = after[k] = -1
        if i >= 0:
            after[i] = j
        if j >= 0:
            before[j] = i
        for m in (i, k, j):
            if m >= 0:
                left -= np.isfinite(loss[m])
                loss[m] = _loss(rays, before, after, m, undrawn)
                left += np.isfinite(loss[m])
    return before, after


@compiled
def _loss(rays: Floats, before: Integers, after: Integers, k: int, undrawn: float) -> float:
    """What the likelihood loses with vertex k: a shorter way round it, or the rays of the line that ends in it."""
    i, j = before[k], after[k]
    if i >= 0 and j >= 0:
        return _chord_error(rays, i, j) - _chord_error(rays, i, k) - _chord_error(rays, k, j)
    if i < 0 and j < 0:
        return np.inf
    a, b = (i, k) if j < 0 else (k, j)
    whole = (before[a] < 0) and (after[b] < 0)
    return float(undrawn * (b - a + (1 if whole else 0)) - _chord_error(rays, a, b))


@compiled
def _chord_error(rays: Floats, i: int, j: int) -> float:
    """Squared radial error of the chord from ray i to ray j over the rays between."""
    dx, dy = rays[j, 0] - rays[i, 0], rays[j, 1] - rays[i, 1]
    total = 0.0
    for k in range(i + 1, j):
        length = np.hypot(rays[k, 0], rays[k, 1])
        miss = length * ((rays[i, 0] * dy - rays[i, 1] * dx) / (rays[k, 0] * dy - rays[k, 1] * dx) - 1.0)
        total += miss * miss
    return total
