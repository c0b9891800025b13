"""Constellations: the largest set of knot pairs that one rigid motion explains, as a maximum clique."""

import numpy as np

from frontend.compiled import compiled
from frontend.rigid_motion import wrap
from frontend.scan import Booleans, Floats, Integers


def consistent(a: Floats, b: Floats, turns: Floats, distance_gate: float, turn_gate: float) -> Booleans:
    """Whether pairs p and q (p, p) can share one motion.

    a, b: (p, 2) positions of each pair's knots in their own frames; turns: (p,) the heading each pair asks for. Both
    must see the knots equally far apart, in the direction their own turn foretells, and ask for the same heading.
    """
    across_a, across_b = a[:, None] - a[None], b[:, None] - b[None]
    far_a, far_b = np.linalg.norm(across_a, axis=2), np.linalg.norm(across_b, axis=2)
    same_distance = np.abs(far_a - far_b) < distance_gate
    same_turn = ~(np.abs(wrap(turns[:, None] - turns[None])) >= turn_gate)
    bearing = np.arctan2(across_a[..., 1], across_a[..., 0]) - np.arctan2(across_b[..., 1], across_b[..., 0])
    off = np.abs(wrap(bearing - turns[:, None]))
    slack = turn_gate + np.arctan2(distance_gate, np.maximum(far_a, 1e-9))
    aligned = ~(off >= slack)  # a pair without a direction of its own contradicts none
    return np.asarray(same_distance & same_turn & aligned & aligned.T)


@compiled
def constellations(graph: Booleans) -> list[Integers]:
    """For each pair the largest clique around it, without repeats."""
    found = [np.empty(0, dtype=np.int64) for _ in range(0)]
    for seed in range(graph.shape[0]):
        around = np.flatnonzero(graph[seed])
        inside = graph[around][:, around]
        clique = np.sort(np.append(around[largest_clique(inside)], seed))
        known = False
        for other in found:
            known = known or bool(other.size == clique.size and np.all(other == clique))
        if not known:
            found.append(clique)
    return found


@compiled
def largest_clique(graph: Booleans) -> Integers:
    """A maximum clique (c,) of the symmetric graph (p, p), exact: branch and bound with greedy colouring."""
    n = graph.shape[0]
    best = np.empty(0, dtype=np.int64)
    if n == 0:
        return best
    depth = 0
    current = np.empty(n + 1, dtype=np.int64)
    order = np.empty((n + 1, n), dtype=np.int64)
    bound = np.empty((n + 1, n), dtype=np.int64)
    left = np.empty(n + 1, dtype=np.int64)
    left[0] = _colour(graph, np.arange(n), order[0], bound[0])
    while depth >= 0:
        if left[depth] == 0 or depth + bound[depth, left[depth] - 1] <= best.size:
            depth -= 1
            continue
        left[depth] -= 1
        vertex = order[depth, left[depth]]
        current[depth] = vertex
        if depth + 1 > best.size:
            best = current[: depth + 1].copy()
        rest = order[depth, : left[depth]]
        rest = rest[graph[vertex][rest]]
        left[depth + 1] = _colour(graph, rest, order[depth + 1], bound[depth + 1])
        depth += 1
    return best


@compiled
def _colour(graph: Booleans, vertices: Integers, order: Integers, bound: Integers) -> int:
    """Greedy colouring: writes the vertices by colour and each one's colour, an upper bound of the clique up to it."""
    waiting = np.ones(vertices.size, dtype=np.bool_)
    placed, colour = 0, 0
    while placed < vertices.size:
        colour += 1
        first = placed
        for v in range(vertices.size):
            if not waiting[v]:
                continue
            clash = False
            for k in range(first, placed):
                if graph[vertices[v], order[k]]:
                    clash = True
                    break
            if not clash:
                order[placed], bound[placed] = vertices[v], colour
                waiting[v] = False
                placed += 1
    return placed
