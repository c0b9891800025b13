"""Ways from a pose to the nodes of the graph: straight to the nearest point of a spine, then along it to a crossing."""

import numpy as np
from numpy.typing import NDArray

from planners.circular import joined, shared
from planners.compiled import compiled, kernel
from planners.slices import Body, Slices
from planners.spine_graph import SpineGraph, run_between
from planners.way_in import STEPS, common, cost_of, departures, standing_arcs

Floats = NDArray[np.float64]

# A row holds the arcs of a departure, of the turn at the foot, of the foot's slice and of the leg along the spine.
CROSSED, AT_FOOT, LEG = STEPS, STEPS + 2, STEPS + 4
FOOT, NODE, COST = STEPS + 6, STEPS + 8, STEPS + 9  # then where the foot is, the node that is reached, and metres
ROW = STEPS + 10


@kernel
def _foot(slices: Slices, cone: int, point: Floats) -> Floats:
    """Of the point of a spine nearest to `point` (2,): x, y, place (0 … 1) and squared distance."""
    begin, end, foot = slices.pieces[slices.first[cone]], slices.pieces[slices.first[cone + 1] - 1], np.empty(4)
    x, y = end[2] - begin[0], end[3] - begin[1]
    place = ((point[0] - begin[0]) * x + (point[1] - begin[1]) * y) / (x * x + y * y)
    foot[2] = min(max(place, 0.0), 1.0)
    foot[0], foot[1] = begin[0] + foot[2] * x, begin[1] + foot[2] * y
    foot[3] = (foot[0] - point[0]) ** 2 + (foot[1] - point[1]) ** 2
    return foot


@kernel
def _slice_at(slices: Slices, cone: int, place: float) -> int:
    """The slice of a cone that holds a place (0 … 1) on its spine."""
    row = slices.first[cone]
    while row + 1 < slices.first[cone + 1] and slices.places[row + 1] <= 2 * cone + place:
        row += 1
    return int(row)


@kernel
def _along(slices: Slices, graph: SpineGraph, row: int, stop: int, head: Floats) -> Floats:
    """From a slice along its spine to a stop: rows (r, ROW) that begin as `head` (ROW,), one for each node and leg."""
    other, arc, both = int(graph.stops[stop, 2]), np.empty((1, 2)), np.empty((2, 2))
    arc[0, 0], arc[0, 1] = head[AT_FOOT], head[AT_FOOT + 1]
    legs = common(run_between(slices, min(row, other), max(row, other)), arc)
    begin, end = graph.first_node[stop], graph.first_node[stop + 1]
    rows, count = np.empty((2 * legs.shape[0] * (end - begin), ROW)), 0
    for leg in range(legs.shape[0]):
        for node in range(begin, end):
            for _ in range(shared(graph.arcs[node, 0], graph.arcs[node, 1], legs[leg, 0], legs[leg, 1], both)):
                for k in range(ROW):
                    rows[count, k] = head[k]
                rows[count, LEG], rows[count, LEG + 1], rows[count, NODE] = legs[leg, 0], legs[leg, 1], node
                count += 1
    return rows[:count].copy()


@kernel
def _to_stops(body: Body, slices: Slices, graph: SpineGraph, cone: int, place: float, head: Floats) -> Floats:
    """Rows (r, ROW) from a place on a spine to the stops before and after it."""
    rows, piece, cost = np.empty((0, ROW)), np.empty(4), head[COST]
    row, after = _slice_at(slices, cone, place), graph.first_stop[cone]
    while after < graph.first_stop[cone + 1] and graph.stops[after, 1] < place:
        after += 1
    for stop in range(max(graph.first_stop[cone], after - 1), min(graph.first_stop[cone + 1], after + 1)):
        piece[0], piece[1] = head[FOOT], head[FOOT + 1]
        piece[2], piece[3] = graph.stop_points[stop, 0], graph.stop_points[stop, 1]
        head[COST] = cost + cost_of(body, piece)
        rows = np.concatenate((rows, _along(slices, graph, row, stop, head)))
    return rows


@kernel
def _by_spine(body: Body, slices: Slices, graph: SpineGraph, pose: Floats, here: Floats, cone: int) -> Floats:
    """Rows (r, ROW) of the ways from a pose (3,) by one spine; here: the legal arcs at the pose."""
    foot, piece, head, rows = _foot(slices, cone, pose), np.empty(4), np.empty(ROW), np.empty((0, ROW))
    for axis in range(2):
        piece[axis], piece[2 + axis], head[FOOT + axis] = pose[axis], foot[axis], foot[axis]
    row = _slice_at(slices, cone, foot[2])
    at_foot = joined(slices.legal[row, : slices.counts[row]])
    ways, cost = departures(body, here, piece)
    for way in range(ways.shape[0]):
        crossed = common(ways[way : way + 1, STEPS - 2 : STEPS].copy(), at_foot)
        for k in range(STEPS):
            head[k] = ways[way, k]
        for turn in range(crossed.shape[0]):
            for side in range(2):
                head[CROSSED + side], head[AT_FOOT + side] = crossed[turn, side], crossed[turn, 4 + side]
            head[COST] = cost
            rows = np.concatenate((rows, _to_stops(body, slices, graph, cone, foot[2], head)))
    return rows


@compiled
def entrances(body: Body, slices: Slices, graph: SpineGraph, pose: Floats, most: int) -> Floats:
    """Ways (r, ROW) from a pose (3,) to nodes of the graph, by the `most` nearest spines."""
    squares, here, rows = np.empty(slices.first.size - 1), standing_arcs(body, pose), np.empty((0, ROW))
    for cone in range(squares.size):
        squares[cone] = _foot(slices, cone, pose)[3]
    for _ in range(min(most, squares.size)):
        cone = int(np.argmin(squares))
        squares[cone] = np.inf
        rows = np.concatenate((rows, _by_spine(body, slices, graph, pose, here, cone)))
    return rows
