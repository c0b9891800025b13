"""The search of configuration space: best channels of EMPTY and MIXED boxes, refined where they are MIXED.

A* runs over states (box, sheet): a robot that looks the same at s headings needs boxes over one s-th of the circle
only, and the sheet says which s-th. A channel whose boxes are all EMPTY is a path; when no channel is left without
the boxes that are too small to cut, the search is over.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.cells import EMPTY, MIXED, Walls
from planners.compiled import compiled
from planners.outline import Outline
from planners.state_queue import Queue, pop, push
from planners.subdivision import CELLS, Tree, cut, has_room

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

FOUND, BLOCKED, EXHAUSTED = 0, 1, 2  # an EMPTY channel; no channel; no rows left


class Query(NamedTuple):
    """start, goal (3,), headings in [0, 2π) or nan for any. sheets: s. period: 2π/s.

    factors (5,): what a metre through a box of each label costs, inf where it must not go. turn_cost: metres per
    radian. levels: how often the MIXED boxes of a channel are halved before the next search.
    """

    start: Floats
    goal: Floats
    sheets: int
    period: float
    factors: Floats
    turn_cost: float
    levels: int


class Front(NamedTuple):
    """A*'s rows per state: cost so far, entry point (3,) with the heading inside the box, parent, search stamps."""

    cost: Floats
    entry: Floats
    parent: Ints
    seen: Ints
    closed: Ints


def front_for(tree: Tree, sheets: int) -> Front:
    """Rows for every state of `tree`."""
    states = tree.labels.size * sheets
    parent, seen, closed = np.empty(states, np.int32), np.zeros(states, np.int32), np.zeros(states, np.int32)
    return Front(np.empty(states), np.empty((states, 3)), parent, seen, closed)


@compiled
def _holds(tree: Tree, cell: int, pose: Floats, period: float) -> bool:
    """Whether a box holds a pose (3,); any heading if it is nan."""
    low, high = tree.lows[cell], tree.highs[cell]
    within = low[0] <= pose[0] <= high[0] and low[1] <= pose[1] <= high[1]
    heading = pose[2] % period
    return bool(within and (np.isnan(heading) or low[2] <= heading <= high[2]))


@compiled
def _on_sheet(pose: Floats, sheet: int, query: Query) -> bool:
    return bool(np.isnan(pose[2]) or sheet == int(pose[2] // query.period) % query.sheets)


@compiled
def _step(tree: Tree, link: int, way: Floats, out: Floats) -> None:
    """The entry point `out` (3,) of the next box, on the shared face.

    way: (2, 3) the entry point of this box and the goal; the straight line between them is followed and clamped.
    """
    source, target, face = tree.links[tree.links[link, 1], 0], tree.links[link, 0], tree.links[link, 4]
    axis, share = min(face // 2, 2), 0.0
    plane = tree.highs[source, axis] if face % 2 == 1 else tree.lows[source, axis]
    if axis < 2 and (way[1, axis] - way[0, axis]) * (plane - way[0, axis]) > 0:
        share = min(1.0, (plane - way[0, axis]) / (way[1, axis] - way[0, axis]))
    for k in range(3):
        wish = way[0, k] + share * (way[1, k] - way[0, k]) if k < 2 else way[0, k]
        low, high = max(tree.lows[source, k], tree.lows[target, k]), min(tree.highs[source, k], tree.highs[target, k])
        out[k] = min(max(wish, low), high)
    if axis < 2:
        out[axis] = plane
    else:
        out[2] = tree.lows[target, 2] if face % 2 == 1 else tree.highs[target, 2]


@compiled
def _begin(tree: Tree, query: Query, front: Front, queue: Queue, stamp: int) -> None:
    """Queue the states that hold the start."""
    for cell in range(tree.used[CELLS]):
        if np.isfinite(query.factors[tree.labels[cell]]) and _holds(tree, cell, query.start, query.period):
            for sheet in range(query.sheets):
                if _on_sheet(query.start, sheet, query):
                    state = cell * query.sheets + sheet
                    front.cost[state], front.parent[state], front.seen[state] = 0.0, -1, stamp
                    front.entry[state, 0], front.entry[state, 1] = query.start[0], query.start[1]
                    front.entry[state, 2] = query.start[2] % query.period
                    if np.isnan(query.start[2]):
                        front.entry[state, 2] = (tree.lows[cell, 2] + tree.highs[cell, 2]) / 2
                    push(queue, state, 0.0)


@compiled
def _expand(tree: Tree, query: Query, front: Front, queue: Queue, state: int) -> None:
    """Queue the neighbours of a state, or move them forward."""
    cell, sheet, stamp = state // query.sheets, state % query.sheets, front.seen[state]
    out, way = np.empty(3), np.empty((2, 3))
    for k in range(3):
        way[0, k], way[1, k] = front.entry[state, k], query.goal[k]
    link = tree.first[cell]
    while link >= 0:
        target, face = tree.links[link, 0], tree.links[link, 4]
        reached = target * query.sheets + (sheet + (face == 7) - (face == 6)) % query.sheets
        if front.closed[reached] != stamp and np.isfinite(query.factors[tree.labels[target]]):
            _step(tree, link, way, out)
            turn = abs(out[2] - way[0, 2])
            if face >= 6:
                turn = abs(turn - query.period)
            step = np.hypot(out[0] - way[0, 0], out[1] - way[0, 1]) + query.turn_cost * turn
            cost = front.cost[state] + step * query.factors[tree.labels[cell]]
            if front.seen[reached] != stamp or cost < front.cost[reached]:
                front.cost[reached], front.parent[reached], front.seen[reached] = cost, state, stamp
                for k in range(3):
                    front.entry[reached, k] = out[k]
                push(queue, reached, cost + np.hypot(out[0] - query.goal[0], out[1] - query.goal[1]))
        link = tree.links[link, 2]


@compiled
def search(tree: Tree, query: Query, front: Front, queue: Queue, stamp: int) -> int:
    """The last state of the best channel, or −1; closed states carry `stamp`."""
    queue.size[0] = 0
    _begin(tree, query, front, queue, stamp)
    while queue.size[0] > 0:
        state = pop(queue)
        front.closed[state] = stamp
        cell = state // query.sheets
        if _on_sheet(query.goal, state % query.sheets, query) and _holds(tree, cell, query.goal, query.period):
            return state
        _expand(tree, query, front, queue, state)
    return -1


@compiled
def _cut_deep(tree: Tree, outer: Outline, core: Outline, walls: Walls, cell: int, levels: int) -> bool:
    """Halve a box `levels` times over where it stays MIXED; whether the rows sufficed."""
    begin, end = cell, cell + 1
    for _ in range(levels):
        following = tree.used[CELLS]
        for each in range(begin, end):
            if tree.labels[each] == MIXED:
                if not has_room(tree, each):
                    return False
                cut(tree, outer, core, walls, each)
        begin, end = following, tree.used[CELLS]
    return True


@compiled
def refine(
    tree: Tree, outlines: tuple[Outline, Outline], walls: Walls, query: Query, front: Front, queue: Queue
) -> tuple[int, int, int]:
    """Search and refine until the answer is known: FOUND, BLOCKED or EXHAUSTED; the last state; searches made.

    outlines: the robot's outer outline, by which boxes are EMPTY, and the core outline, by which they are FULL.
    """
    stamp = 0
    while True:
        stamp += 1
        last = search(tree, query, front, queue, stamp)
        if last < 0:
            return BLOCKED, -1, stamp
        state, certain = last, True
        while state >= 0:
            cell = state // query.sheets
            if tree.labels[cell] != EMPTY:
                certain = False
                if tree.labels[cell] == MIXED and not _cut_deep(
                    tree, outlines[0], outlines[1], walls, cell, query.levels
                ):
                    return EXHAUSTED, -1, stamp
            state = front.parent[state]
        if certain:
            return FOUND, last, stamp
