"""How far it is to the goal for a disc that the robot holds: what leads the search of configuration space.

Nodes on a raster that leave the disc room are open. From the goal, shortest ways spread over open nodes and from there
into walls, never out of them, so every place knows how far around the walls the goal is. No robot has a shorter way
than the disc in it, so the guide leads well; it is no bound, as ways on a raster keep to 16 directions.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled
from planners.state_queue import Queue, pop, push, queue_for
from planners.world import World

Floats = NDArray[np.float64]
Marks = NDArray[np.uint8]

STEPS = 2.0  # per radius of the disc; larger knows narrow passages better and takes longer
NODES = 300_000  # in all; larger follows small robots in large worlds and takes longer
# To one of 16 neighbours, and the two nodes that a knight's move passes between; other moves pass none.
MOVES = np.array(
    [
        (x, y, int(x / 2), int(y / 2), x - int(x / 2), y - int(y / 2))
        for x in range(-2, 3)
        for y in range(-2, 3)
        if (x or y) and (max(abs(x), abs(y)) == 1 or abs(x) + abs(y) == 3)
    ],
    dtype=np.int64,
)


class Guide(NamedTuple):
    """left (i, j): metres to the goal from the nodes at corner (2,) + step · (i, j)."""

    left: Floats
    corner: Floats
    step: float


def guide_to(world: World, radius: float, goal: Floats) -> Guide:
    """How far it is from everywhere to `goal` for the centre of a disc; where there is no way, farther than anywhere.

    radius may be 0: then walls are as thick as the raster needs to see them.
    """
    left, bottom, right, top = world.bounds
    step = max(radius / STEPS, float(np.sqrt((right - left) * (top - bottom) / NODES)))
    corner, shape = np.array([left, bottom]), (int((right - left) / step) + 2, int((top - bottom) / step) + 2)
    # A disc may stand up to 0.71 steps from the nearest node; thinner walls than this, moves would step across.
    near = max(radius - step * np.sqrt(0.5), step * np.sqrt(0.5))
    shut = _shut(world.edges.reshape(-1, 4).copy(), corner, step, near, np.zeros(shape, np.uint8))
    metres = _spread(shut, ((goal[:2] - corner) / step).astype(np.int64), queue_for(shut.size)) * step
    known = np.isfinite(metres)
    nodes = corner + step * np.moveaxis(np.indices(shape), 0, -1)
    straight = np.linalg.norm(nodes - goal[:2], axis=-1)
    return Guide(np.where(known, metres, metres[known].max() + straight), corner, step)


@compiled
def left(guide: Guide, place: Floats) -> float:
    """Metres to the goal from a place whose first two coordinates are x and y."""
    x, y = (place[0] - guide.corner[0]) / guide.step, (place[1] - guide.corner[1]) / guide.step
    i = min(max(int(x), 0), guide.left.shape[0] - 2)
    j = min(max(int(y), 0), guide.left.shape[1] - 2)
    x, y = x - i, y - j
    lower = guide.left[i, j] * (1 - x) + guide.left[i + 1, j] * x
    upper = guide.left[i, j + 1] * (1 - x) + guide.left[i + 1, j + 1] * x
    return float(lower * (1 - y) + upper * y)


@compiled
def _shut(ends: Floats, corner: Floats, step: float, near: float, shut: Marks) -> Marks:
    """Mark the nodes nearer than `near` to a wall (4,) of `ends`."""
    for k in range(ends.shape[0]):
        x0, y0 = ends[k, 0] - corner[0], ends[k, 1] - corner[1]
        along_x, along_y = ends[k, 2] - ends[k, 0], ends[k, 3] - ends[k, 1]
        squared = along_x * along_x + along_y * along_y
        low_i, high_i = (x0 + min(along_x, 0.0) - near) / step, (x0 + max(along_x, 0.0) + near) / step
        low_j, high_j = (y0 + min(along_y, 0.0) - near) / step, (y0 + max(along_y, 0.0) + near) / step
        for i in range(max(int(low_i), 0), min(int(high_i) + 1, shut.shape[0])):
            for j in range(max(int(low_j), 0), min(int(high_j) + 1, shut.shape[1])):
                x, y = i * step - x0, j * step - y0
                share = min(max((x * along_x + y * along_y) / squared, 0.0), 1.0)
                if (x - share * along_x) ** 2 + (y - share * along_y) ** 2 < near * near:
                    shut[i, j] = 1
    return shut


@compiled
def _spread(shut: Marks, goal: NDArray[np.int64], queue: Queue) -> Floats:
    """Steps (i, j) from the goal to all nodes, inf where there is no way."""
    columns, rows = shut.shape
    metres, closed = np.full(columns * rows, np.inf), np.zeros(columns * rows, np.uint8)
    for i in range(goal[0], goal[0] + 2):
        for j in range(goal[1], goal[1] + 2):
            metres[i * rows + j] = 0.0
            push(queue, i * rows + j, 0.0)
    while queue.size[0] > 0:
        node = pop(queue)
        closed[node], i, j = 1, node // rows, node % rows
        for k in range(MOVES.shape[0]):
            u, v = i + MOVES[k, 0], j + MOVES[k, 1]
            if u < 0 or v < 0 or u >= columns or v >= rows or closed[u * rows + v] == 1:
                continue
            passed = max(shut[i + MOVES[k, 2], j + MOVES[k, 3]], shut[i + MOVES[k, 4], j + MOVES[k, 5]])
            if shut[u, v] == 0 and max(shut[i, j], passed) == 1:
                continue
            reached = metres[node] + np.sqrt(MOVES[k, 0] ** 2 + MOVES[k, 1] ** 2)
            if reached < metres[u * rows + v]:
                metres[u * rows + v] = reached
                push(queue, u * rows + v, reached)
    return metres.reshape((columns, rows))
