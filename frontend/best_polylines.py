"""The most likely polylines of a scan with a given number of vertices (likelihood of Schaefer et al. 2018).

A scan is drawn as several polylines: none crosses a gap, and rays that no line explains cheaply stay undrawn. Where
Schaefer removes vertices greedily, the choice of rays here is exact, by dynamic programming over chords; then the
vertices move freely to the least squares along the rays.
"""

from dataclasses import dataclass

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True, eq=False)
class Polylines:
    """vertices: (v, 2) in the order of the rays. rays: (v,) the ray each stands by. joined: (v,) with the next one."""

    vertices: Floats
    rays: Integers
    joined: Booleans


def best_polylines(rays: Floats, joined: Booleans, count: int, undrawn: float) -> Polylines:
    """At most `count` vertices that leave the least sum of squared misses along the rays.

    rays: (n, 2) their ends in order of bearing, the sensor at the origin. joined: (n,) whether a ray's end and the next
    may lie on one line. undrawn: metres that a ray on no line counts for; larger draws more rays less closely.
    """
    chosen, last = cheapest_chains(chord_costs(rays, joined, undrawn**2), count, undrawn**2)
    return Polylines(settled(rays, chosen, last), chosen, ~last)


@compiled
def chord_costs(rays: Floats, joined: Booleans, undrawn: float) -> Floats:
    """Sum (n, n) of squared misses of the chord from ray i to ray j over the rays between; inf where none may be drawn.

    A chord that costs more than leaving its rays undrawn is never part of the best.
    """
    n = rays.shape[0]
    squares = rays[:, 0] ** 2 + rays[:, 1] ** 2
    costs = np.full((n, n), np.inf)
    for i in range(n - 1):
        j = i + 1
        while j < n and joined[j - 1]:
            dx, dy = rays[j, 0] - rays[i, 0], rays[j, 1] - rays[i, 1]
            top = rays[i, 0] * dy - rays[i, 1] * dx
            budget = undrawn * (j - i - 1)
            cost = 0.0
            for k in range(i + 1, j):
                miss = top / (rays[k, 0] * dy - rays[k, 1] * dx) - 1.0  # in units of the ray's length
                cost += miss * miss * squares[k]
                if not cost <= budget:
                    break
            if cost <= budget:
                costs[i, j] = cost
            j += 1
    return costs


@compiled
def cheapest_chains(costs: Floats, count: int, undrawn: float) -> tuple[Integers, Booleans]:
    """Rays (v,) that the vertices of the cheapest polylines stand by, v ≤ count, and which end a polyline (v,).

    up[v, j]: least cost of all rays before j with v vertices and no line open; down[v, j]: of all rays to j, where a
    line of at least two vertices has its latest. A line opens at j for the cost up[v − 1, j].
    """
    n = costs.shape[0]
    up = np.full((count + 1, n + 1), np.inf)
    down = np.full((count + 1, n), np.inf)
    came = np.zeros((count + 1, n), dtype=np.int64)
    up[0] = np.arange(n + 1) * undrawn
    for v in range(1, count + 1):
        for i in range(n):
            so_far = min(down[v - 1, i], up[v - 2, i] if v > 1 else np.inf)
            j = i + 1
            while j < n and v > 1:
                total = so_far + costs[i, j]
                if total < down[v, j]:
                    down[v, j], came[v, j] = total, i
                j += 1
        for j in range(n):
            up[v, j + 1] = min(up[v, j] + undrawn, down[v, j])
    return _traced(up, down, came)


@compiled
def _traced(up: Floats, down: Floats, came: Integers) -> tuple[Integers, Booleans]:
    """The vertices that led to the cheapest end, in order, and which of them end a polyline."""
    count, n = down.shape[0] - 1, down.shape[1]
    chosen, last = np.empty(count, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    v, j, first = int(np.argmin(up[:, n])), n, count
    while v > 0:
        if up[v, j] != down[v, j - 1]:
            j -= 1
            continue
        first -= 1
        chosen[first], last[first] = j - 1, True
        opened = False
        while not opened:
            i, v = came[v, chosen[first]], v - 1
            first -= 1
            chosen[first] = i
            opened = not down[v, i] <= (up[v - 1, i] if v > 0 else np.inf)
        v, j = v - 1, chosen[first]
    return chosen[first:], last[first:]


@compiled
def settled(rays: Floats, chosen: Integers, last: Booleans) -> Floats:
    """Vertices (v, 2) moved from the chosen rays to the least squares along the rays, by damped Gauss–Newton.

    Ends of a polyline slide along their own ray, so that the rays drawn stay the same; the others move freely.
    """
    vertices = rays[chosen].copy()
    damping = 1e-2
    normal, pull, error = _normal_equations(rays, chosen, last, vertices)
    for _ in range(12):
        damped = normal + damping * np.eye(pull.size)
        moved = vertices + np.linalg.solve(damped, pull).reshape(vertices.shape)
        trial = _normal_equations(rays, chosen, last, moved)
        if trial[2] < error:
            gain = error - trial[2]
            vertices, (normal, pull, error) = moved, trial
            damping *= 0.1
            if gain < 1e-3 * error:
                break
        else:
            damping *= 10.0
            if damping > 1e3:
                break
    return vertices


@compiled
def _normal_equations(rays: Floats, chosen: Integers, last: Booleans, vertices: Floats) -> tuple[Floats, Floats, float]:
    """Normal matrix (2v, 2v), pull (2v,) and sum of squared misses; inf where the vertices are out of order."""
    v = chosen.size
    normal, pull, error = np.zeros((2 * v, 2 * v)), np.zeros(2 * v), 0.0
    slope = np.empty(4)
    for e in range(v - 1):
        if not last[e] and not vertices[e, 0] * vertices[e + 1, 1] > vertices[e, 1] * vertices[e + 1, 0]:
            return normal, pull, np.inf
    e = 0
    while e < v:
        end = e
        while not last[end]:
            end += 1
        for k in range(chosen[e], chosen[end] + 1):
            while e + 1 < end and rays[k, 1] * vertices[e + 1, 0] > rays[k, 0] * vertices[e + 1, 1]:
                e += 1
            miss = _miss(rays[k], vertices[e], vertices[e + 1], slope)
            if e == 0 or last[e - 1]:
                _slide_only(slope[:2], rays[chosen[e]])
            if e + 1 == end:
                _slide_only(slope[2:], rays[chosen[end]])
            error += miss * miss
            for a in range(4):
                pull[2 * e + a] += slope[a] * miss
                for b in range(4):
                    normal[2 * e + a, 2 * e + b] += slope[a] * slope[b]
        e = end + 1
    return normal, pull, error


@compiled
def _miss(ray: Floats, p: Floats, q: Floats, slope: Floats) -> float:
    """How much longer the ray is than the line from p to q says; writes how the line's reach (4,) follows p and q."""
    length = np.hypot(ray[0], ray[1])
    ux, uy = ray[0] / length, ray[1] / length
    area = p[0] * q[1] - p[1] * q[0]
    reach = area / (ux * (q[1] - p[1]) - uy * (q[0] - p[0]))
    scale = reach / area
    slope[0] = scale * (q[1] - reach * uy)
    slope[1] = scale * (reach * ux - q[0])
    slope[2] = scale * (reach * uy - p[1])
    slope[3] = scale * (p[0] - reach * ux)
    return float(length - reach)


@compiled
def _slide_only(slope: Floats, ray: Floats) -> None:
    """Leaves of a vertex's slope (2,) what lies along its ray."""
    along = (slope[0] * ray[0] + slope[1] * ray[1]) / (ray[0] ** 2 + ray[1] ** 2)
    slope[0], slope[1] = along * ray[0], along * ray[1]
