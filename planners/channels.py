"""The search of configuration space: best channels of EMPTY and MIXED boxes, refined where they are MIXED.

A* runs over states (box, sheet): a robot that looks the same at s headings needs boxes over one s-th of the circle
only, and the sheet says which s-th. It is led by the way that a disc inside the robot has left, so that boxes not yet
cut promise no short cuts through walls. A channel whose boxes are all EMPTY is a path; one that is not is cut and
searched anew by itself, with the boxes beside it, for as long as this is cheaper than to search everywhere. When no
channel is left without the boxes that are too small to cut, the search is over.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.cells import EMPTY, MIXED, Walls
from planners.compiled import compiled, kernel
from planners.guide import Guide, left
from planners.outline import Outline
from planners.state_queue import Queue, pop, push
from planners.subdivision import CELLS, Tree, cut, has_room

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

FOUND, BLOCKED, EXHAUSTED, CUT = 0, 1, 2, 3  # an EMPTY channel; no channel; no rows left; go on
EVERYWHERE = 0  # the number that no channel has


class Query(NamedTuple):
    """start, goal (3,), headings in [0, 2π) or nan for any. sheets: s. period: 2π/s.

    factors (5,): what a metre through a box of each label costs, inf where it must not go. turn_cost: metres per
    radian. levels: how often the MIXED boxes of a channel are halved before the next search. guide: to the goal.
    """

    start: Floats
    goal: Floats
    sheets: int
    period: float
    factors: Floats
    turn_cost: float
    levels: int
    guide: Guide


class Front(NamedTuple):
    """A*'s rows per state: cost so far, entry point (3,) with the heading inside the box, parent, search stamps; and
    per box the last channel (n,) that it lay beside."""

    cost: Floats
    entry: Floats
    parent: Ints
    seen: Ints
    closed: Ints
    channel: Ints


def front_for(tree: Tree, sheets: int) -> Front:
    """Rows for every state of `tree`."""
    states = tree.labels.size * sheets
    parent, seen, closed = np.empty(states, np.int32), np.zeros(states, np.int32), np.zeros(states, np.int32)
    channel = np.zeros(tree.labels.size, np.int32)
    return Front(np.empty(states), np.empty((states, 3)), parent, seen, closed, channel)


def forget(front: Front) -> None:
    """Make the rows ready for another query."""
    for rows in (front.seen, front.closed, front.channel):
        rows[:] = 0


@kernel
def _holds(tree: Tree, cell: int, pose: Floats, period: float) -> bool:
    """Whether a box holds a pose (3,); any heading if it is nan."""
    low, high = tree.lows[cell], tree.highs[cell]
    within = low[0] <= pose[0] <= high[0] and low[1] <= pose[1] <= high[1]
    heading = pose[2] % period
    return bool(within and (np.isnan(heading) or low[2] <= heading <= high[2]))


@kernel
def _on_sheet(pose: Floats, sheet: int, query: Query) -> bool:
    return bool(np.isnan(pose[2]) or sheet == int(pose[2] // query.period) % query.sheets)


@kernel
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


@kernel
def _within(tree: Tree, query: Query, front: Front, cell: int, channel: int) -> bool:
    """Whether a search of one channel, or of EVERYWHERE, may go through a box."""
    here = channel == EVERYWHERE or channel == front.channel[cell]
    return bool(here and np.isfinite(query.factors[tree.labels[cell]]))


@kernel
def _begin(tree: Tree, query: Query, front: Front, queue: Queue, stamp: int, channel: int) -> None:
    """Queue the states that hold the start."""
    for cell in range(tree.used[CELLS]):
        if _within(tree, query, front, cell, channel) and _holds(tree, cell, query.start, query.period):
            for sheet in range(query.sheets):
                if _on_sheet(query.start, sheet, query):
                    state = cell * query.sheets + sheet
                    front.cost[state], front.parent[state], front.seen[state] = 0.0, -1, stamp
                    front.entry[state, 0], front.entry[state, 1] = query.start[0], query.start[1]
                    front.entry[state, 2] = query.start[2] % query.period
                    if np.isnan(query.start[2]):
                        front.entry[state, 2] = (tree.lows[cell, 2] + tree.highs[cell, 2]) / 2
                    push(queue, state, 0.0)


@kernel
def _expand(tree: Tree, query: Query, front: Front, queue: Queue, state: int, channel: int) -> None:
    """Queue the neighbours of a state, or move them forward; no way costs less than the guide has come nearer."""
    cell, sheet, stamp = state // query.sheets, state % query.sheets, front.seen[state]
    out, way = np.empty(3), np.empty((2, 3))
    for k in range(3):
        way[0, k], way[1, k] = front.entry[state, k], query.goal[k]
    link, here = tree.first[cell], left(query.guide, way[0])
    while link >= 0:
        target, face = tree.links[link, 0], tree.links[link, 4]
        reached = target * query.sheets + (sheet + (face == 7) - (face == 6)) % query.sheets
        if front.closed[reached] != stamp and _within(tree, query, front, target, channel):
            _step(tree, link, way, out)
            turn = abs(out[2] - way[0, 2])
            if face >= 6:
                turn = abs(turn - query.period)
            step = np.hypot(out[0] - way[0, 0], out[1] - way[0, 1]) + query.turn_cost * turn
            there = left(query.guide, out)
            cost = front.cost[state] + max(step * query.factors[tree.labels[cell]], here - there)
            if front.seen[reached] != stamp or cost < front.cost[reached]:
                front.cost[reached], front.parent[reached], front.seen[reached] = cost, state, stamp
                for k in range(3):
                    front.entry[reached, k] = out[k]
                push(queue, reached, cost + there)
        link = tree.links[link, 2]


@compiled
def search(tree: Tree, query: Query, front: Front, queue: Queue, stamp: int, channel: int) -> tuple[int, int]:
    """The last state of the best channel, or −1, and how many states were closed; they carry `stamp`.

    channel: the number of the channel to which the search keeps, or EVERYWHERE.
    """
    queue.size[0], closed = 0, 0
    _begin(tree, query, front, queue, stamp, channel)
    while queue.size[0] > 0:
        state = pop(queue)
        front.closed[state] = stamp
        closed += 1
        cell = state // query.sheets
        if _on_sheet(query.goal, state % query.sheets, query) and _holds(tree, cell, query.goal, query.period):
            return state, closed
        _expand(tree, query, front, queue, state, channel)
    return -1, closed


@kernel
def _cut_deep(
    tree: Tree, outlines: tuple[Outline, Outline], walls: Walls, query: Query, front: Front, cell: int
) -> bool:
    """Halve a box as often as the query says where it stays MIXED; whether the rows sufficed."""
    begin, end = cell, cell + 1
    for _ in range(query.levels):
        following = tree.used[CELLS]
        for each in range(begin, end):
            if tree.labels[each] == MIXED:
                if not has_room(tree, each):
                    return False
                cut(tree, outlines[0], outlines[1], walls, each)
                for half in range(tree.used[CELLS] - 2, tree.used[CELLS]):
                    front.channel[half] = front.channel[each]
        begin, end = following, tree.used[CELLS]
    return True


@kernel
def _mark(tree: Tree, query: Query, front: Front, last: int, channel: int) -> None:
    """Number the boxes of the channel that ends with state `last`, and those beside it."""
    state = last
    while state >= 0:
        cell = state // query.sheets
        front.channel[cell] = channel
        link = tree.first[cell]
        while link >= 0:
            front.channel[tree.links[link, 0]] = channel
            link = tree.links[link, 2]
        state = front.parent[state]


@kernel
def _cut_along(
    tree: Tree, outlines: tuple[Outline, Outline], walls: Walls, query: Query, front: Front, last: int
) -> int:
    """Cut the MIXED boxes of the channel that ends with state `last`; FOUND if there are none."""
    state, status = last, FOUND
    while state >= 0:
        cell = state // query.sheets
        if tree.labels[cell] != EMPTY:
            status = CUT
            if tree.labels[cell] == MIXED and not _cut_deep(tree, outlines, walls, query, front, cell):
                return EXHAUSTED
        state = front.parent[state]
    return status


@compiled
def refine(
    tree: Tree, outlines: tuple[Outline, Outline], walls: Walls, query: Query, front: Front, queue: Queue
) -> tuple[int, int, int]:
    """Search and refine until the answer is known: FOUND, BLOCKED or EXHAUSTED; the last state; searches made.

    outlines: the robot's outer outline, by which boxes are EMPTY, and the core outline, by which they are FULL.
    """
    # As a plain number: the constant would have the searches compiled twice.
    stamp, channel, everywhere = 0, EVERYWHERE, int(EVERYWHERE)
    while True:
        stamp, channel = stamp + 1, channel + 1
        last, spare = search(tree, query, front, queue, stamp, everywhere)
        if last < 0:
            return BLOCKED, -1, stamp
        _mark(tree, query, front, last, channel)
        status = _cut_along(tree, outlines, walls, query, front, last)
        # Searching along the channel may cost as much again as searching everywhere, so at most half is in vain.
        while status == CUT and last >= 0 and spare > 0:
            stamp += 1
            last, closed = search(tree, query, front, queue, stamp, channel)
            spare -= closed
            if last >= 0:
                status = _cut_along(tree, outlines, walls, query, front, last)
        if status != CUT:
            return status, last, stamp
