"""The graph of spines: where cones cross, which headings connect there, and which survive from crossing to crossing.

A node is an arc of legal headings at a crossing, on one of its two cones. Along a spine two nodes are joined by every
arc that is legal in all slices between; at a crossing by every arc common to both cones: the robot translates along
spines and turns where they meet.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.circular import joined, shared
from planners.compiled import compiled, kernel
from planners.orientations import intersected
from planners.slices import Slices

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

SINE = 1e-5  # of the least angle at which spines cross: far above rounding


class SpineGraph(NamedTuple):
    """Stops and nodes.

    stops (s, 3): cone, place (0 … 1) on its spine, slice; sorted by cone and place; stop_points (s, 2).
    first_stop (k + 1,) per cone, first_node (s + 1,) per stop. arcs (n, 2) of each node, node_stop (n,).
    first_edge (n + 1,), targets (e,), costs (e,) in metres, more where it is tight, edge_arcs (e, 2).
    """

    stops: Floats
    stop_points: Floats
    first_stop: Ints
    first_node: Ints
    arcs: Floats
    node_stop: Ints
    first_edge: Ints
    targets: Ints
    costs: Floats
    edge_arcs: Floats


@compiled
def crossings(spines: Floats) -> Floats:
    """Rows (c, 4) of two crossing spines (k, 4) and the places (0 … 1) on them."""
    found, count = np.empty((256, 4)), 0
    for i in range(spines.shape[0]):
        x, y = spines[i, 2] - spines[i, 0], spines[i, 3] - spines[i, 1]
        for j in range(i + 1, spines.shape[0]):
            u, v = spines[j, 2] - spines[j, 0], spines[j, 3] - spines[j, 1]
            turn = x * v - y * u
            # Spines on one line cross nowhere, though rounding may say anything.
            if turn * turn <= SINE**2 * (x * x + y * y) * (u * u + v * v):
                continue
            to_x, to_y = spines[j, 0] - spines[i, 0], spines[j, 1] - spines[i, 1]
            here, there = (to_x * v - to_y * u) / turn, (to_x * y - to_y * x) / turn
            if 0.0 <= here <= 1.0 and 0.0 <= there <= 1.0:
                if count == found.shape[0]:
                    found = np.concatenate((found, np.empty_like(found)))
                found[count, 0], found[count, 1], found[count, 2], found[count, 3] = i, j, here, there
                count += 1
    return found[:count].copy()


@kernel
def run_between(slices: Slices, first: int, last: int) -> Floats:
    """Arcs (k, 2) of headings legal in all slices from row `first` to row `last`."""
    legal = slices.legal[first, : slices.counts[first]]
    for row in range(first + 1, last + 1):
        legal = intersected(legal, slices.legal[row, : slices.counts[row]])
        if legal.shape[0] == 0:
            break
    return joined(legal)


@kernel
def _tightness(slices: Slices, first: int, last: int) -> float:
    """The greatest tightness among the slices from row `first` to row `last`."""
    greatest = 0.0
    for row in range(first, last + 1):
        greatest = max(greatest, slices.tightness[row])
    return greatest


@compiled
def _nodes(slices: Slices, stops: Floats) -> tuple[Ints, Floats, Ints]:
    first_node = np.zeros(stops.shape[0] + 1, np.int32)
    arcs, owner, count = np.empty((8 * stops.shape[0] + 1, 2)), np.empty(8 * stops.shape[0] + 1, np.int32), 0
    for stop in range(stops.shape[0]):
        row = int(stops[stop, 2])
        legal = joined(slices.legal[row, : slices.counts[row]])
        for k in range(legal.shape[0]):
            arcs[count, 0], arcs[count, 1], owner[count] = legal[k, 0], legal[k, 1], stop
            count += 1
        first_node[stop + 1] = count
    return first_node, arcs[:count].copy(), owner[:count].copy()


@compiled
def _runs(slices: Slices, stops: Floats, points: Floats, nodes: tuple[Ints, Floats, Ints], caution: float) -> Floats:
    """Rows (e, 5) node, node, cost, arc along spines, one direction each."""
    first_node, arcs = nodes[0], nodes[1]
    rows, count, both, thrice = np.empty((256, 5)), 0, np.empty((2, 2)), np.empty((2, 2))
    for stop in range(stops.shape[0] - 1):
        if stops[stop, 0] != stops[stop + 1, 0]:
            continue
        legal = run_between(slices, int(stops[stop, 2]), int(stops[stop + 1, 2]))
        length = np.hypot(points[stop, 0] - points[stop + 1, 0], points[stop, 1] - points[stop + 1, 1])
        length *= 1 + caution * _tightness(slices, int(stops[stop, 2]), int(stops[stop + 1, 2]))
        for run in range(legal.shape[0]):
            for a in range(first_node[stop], first_node[stop + 1]):
                if shared(legal[run, 0], legal[run, 1], arcs[a, 0], arcs[a, 1], both) == 0:
                    continue
                for b in range(first_node[stop + 1], first_node[stop + 2]):
                    if shared(legal[run, 0], legal[run, 1], arcs[b, 0], arcs[b, 1], thrice) == 0:
                        continue
                    if count == rows.shape[0]:
                        rows = np.concatenate((rows, np.empty_like(rows)))
                    rows[count, 0], rows[count, 1], rows[count, 2] = a, b, length
                    rows[count, 3], rows[count, 4] = legal[run, 0], legal[run, 1]
                    count += 1
    return rows[:count].copy()


@compiled
def _turns(twins: Ints, nodes: tuple[Ints, Floats, Ints]) -> Floats:
    """Rows (e, 5) node, node, 0, arc at crossings, one direction each. twins (s,): the crossing's stop on the other."""
    first_node, arcs = nodes[0], nodes[1]
    rows, count, both = np.empty((256, 5)), 0, np.empty((2, 2))
    for stop in range(twins.size):
        other = twins[stop]
        if other <= stop:
            continue
        for a in range(first_node[stop], first_node[stop + 1]):
            for b in range(first_node[other], first_node[other + 1]):
                for k in range(shared(arcs[a, 0], arcs[a, 1], arcs[b, 0], arcs[b, 1], both)):
                    if count == rows.shape[0]:
                        rows = np.concatenate((rows, np.empty_like(rows)))
                    rows[count, 0], rows[count, 1], rows[count, 2] = a, b, 0.0
                    rows[count, 3], rows[count, 4] = both[k, 0], both[k, 1]
                    count += 1
    return rows[:count].copy()


def rows_at(slices: Slices, cones: NDArray[np.int64], places: Floats) -> NDArray[np.int64]:
    """The slices (n,) that hold `places` (n,), 0 … 1, on the spines of `cones` (n,)."""
    rows = np.searchsorted(slices.places, 2 * cones + places, side="right") - 1
    return np.asarray(np.clip(rows, slices.first[cones], slices.first[cones + 1] - 1))


def graph_of(slices: Slices, caution: float) -> SpineGraph:
    """All crossings of the cones' spines, and what joins them; a metre in the tightest slice costs 1 + `caution`."""
    sizes = np.diff(slices.first)
    spines = np.column_stack([slices.pieces[slices.first[:-1], :2], slices.pieces[slices.first[1:] - 1, 2:]])
    met = crossings(spines)
    cones = np.concatenate([met[:, 0], met[:, 1]]).astype(np.int64)
    places = np.concatenate([met[:, 2], met[:, 3]])
    rows = rows_at(slices, cones, places)
    order = np.lexsort((places, cones))
    rank = np.empty(len(order), np.int32)
    rank[order] = np.arange(len(order), dtype=np.int32)
    twins = rank[np.roll(np.arange(len(order)), len(met))][order]
    stops = np.column_stack([cones, places, rows])[order]
    points = spines[cones, :2] + places[:, None] * (spines[cones, 2:] - spines[cones, :2])
    nodes = _nodes(slices, stops)
    edges = np.concatenate([_runs(slices, stops, points[order], nodes, caution), _turns(twins, nodes)])
    first_stop = np.searchsorted(stops[:, 0], np.arange(len(sizes) + 1)).astype(np.int32)
    first_edge, targets, costs, edge_arcs = _adjacency(edges, len(nodes[2]))
    return SpineGraph(stops, points[order], first_stop, *nodes, first_edge, targets, costs, edge_arcs)


def _adjacency(edges: Floats, total: int) -> tuple[Ints, Ints, Floats, Floats]:
    """Rows (e, 5) in both directions, sorted by their first node."""
    both = np.concatenate([edges, edges[:, [1, 0, 2, 3, 4]]])
    both = both[np.argsort(both[:, 0], kind="stable")]
    first = np.searchsorted(both[:, 0], np.arange(total + 1)).astype(np.int32)
    return first, both[:, 1].astype(np.int32), both[:, 2].copy(), both[:, 3:].copy()
