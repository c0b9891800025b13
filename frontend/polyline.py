"""Polylines close to every reading along its beam: within a tolerance, or the best of a given number of vertices."""

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


def best_polyline(rays: Floats, count: int) -> Floats:
    """The polyline (count, 2) that misses the rays' ends (n, 2) least along the rays, n ≥ count ≥ 2.

    Exact over all choices of rays as vertices (dynamic programming over chords), then each vertex slides along its
    ray to the least squares. The sensor sits at the origin; the rays are in order and the polyline spans them all.
    """
    budget = rays.shape[0] * 0.05**2
    chosen = np.empty(0, dtype=np.int64)
    while chosen.size == 0:  # chords that alone cost more than the whole polyline need no look
        chosen = cheapest_chain(chord_costs(rays, budget), count, budget)
        budget *= 8.0
    inverses = slid_along_rays(rays, chosen, 1.0 / np.hypot(rays[chosen, 0], rays[chosen, 1]))
    bearings = np.arctan2(rays[chosen, 1], rays[chosen, 0])
    return np.column_stack([np.cos(bearings), np.sin(bearings)]) / inverses[:, None]


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


@compiled
def chord_costs(rays: Floats, budget: float) -> Floats:
    """Squared radial error (n, n) of the chord from ray i to ray j > i over the rays between, inf over the budget."""
    n = rays.shape[0]
    squares = rays[:, 0] ** 2 + rays[:, 1] ** 2
    costs = np.full((n, n), np.inf)
    for i in range(n - 1):
        for j in range(i + 1, n):
            dx, dy = rays[j, 0] - rays[i, 0], rays[j, 1] - rays[i, 1]
            top = rays[i, 0] * dy - rays[i, 1] * dx
            cost = 0.0
            for k in range(i + 1, j):
                miss = top / (rays[k, 0] * dy - rays[k, 1] * dx) - 1.0  # in units of the ray's length
                cost += miss * miss * squares[k]
                if not cost <= budget:
                    break
            if cost <= budget:
                costs[i, j] = cost
    return costs


@compiled
def cheapest_chain(costs: Floats, count: int, budget: float) -> Integers:
    """The `count` vertices from the first to the last with the least sum of costs; empty where over the budget."""
    n = costs.shape[0]
    least = np.full((count, n), np.inf)
    came = np.zeros((count, n), dtype=np.int64)
    least[0, 0] = 0.0
    for v in range(1, count):
        for i in range(v - 1, n - 1):
            so_far = least[v - 1, i]
            if so_far > budget:
                continue
            for j in range(i + 1, n):
                total = so_far + costs[i, j]
                if total < least[v, j]:
                    least[v, j] = total
                    came[v, j] = i
    if not least[count - 1, n - 1] <= budget:
        return np.empty(0, dtype=np.int64)
    chain = np.empty(count, dtype=np.int64)
    chain[count - 1] = n - 1
    for v in range(count - 1, 0, -1):
        chain[v - 1] = came[v, chain[v]]
    return chain


@compiled
def slid_along_rays(rays: Floats, chosen: Integers, inverses: Floats) -> Floats:
    """Inverse lengths (v,) of the vertices on the chosen rays that miss the rays' ends least, by Gauss–Newton.

    A line's inverse range is linear in the inverse ranges of its two ends, so one step is nearly exact.
    """
    bearings = np.unwrap(np.arctan2(rays[:, 1], rays[:, 0]))
    lengths = np.hypot(rays[:, 0], rays[:, 1])
    cost, kept = np.inf, inverses
    for _ in range(6):
        normal = np.eye(chosen.size) * 1e-12
        pull = np.zeros(chosen.size)
        error = 0.0
        for v in range(chosen.size - 1):
            a, b = chosen[v], chosen[v + 1]
            whole = np.sin(bearings[b] - bearings[a])
            for k in range(a, b + 1 if v == chosen.size - 2 else b):
                left, right = np.sin(bearings[b] - bearings[k]) / whole, np.sin(bearings[k] - bearings[a]) / whole
                reach = 1.0 / (left * inverses[v] + right * inverses[v + 1])
                miss = lengths[k] - reach
                error += miss * miss
                left, right = -left * reach * reach, -right * reach * reach
                normal[v, v] += left * left
                normal[v, v + 1] += left * right
                normal[v + 1, v] += left * right
                normal[v + 1, v + 1] += right * right
                pull[v] += left * miss
                pull[v + 1] += right * miss
        if not error < cost:
            return kept
        cost, kept = error, inverses.copy()
        inverses = np.maximum(inverses + np.linalg.solve(normal, pull), 0.25 * inverses)
    return kept
