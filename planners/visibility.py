"""The exact planner for discs: shortest ways among obstacles grown by the radius (Lozano-Pérez & Wesley 1979).

Obstacles grow by circumscribed hulls, so that every way between their corners keeps the radius. Two corners are joined
if the line between them is tangent to both hulls and keeps more than the radius from every wall: a distance, not a
crossing, so nothing leaks between walls that touch. Without a joint component even among inscribed hulls, there is
no path for any disc of that radius.
"""

from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon, Polygon

from planners.compiled import compiled
from planners.orientations import nearest
from planners.raster import Raster, raster_of
from planners.state_queue import Queue, pop, push, queue_for
from planners.world import World, outside_arcs

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

QUARTER = 16  # chords in a quarter circle: the hull stands off by 0.3 % of the radius at most


class Roadmap(NamedTuple):
    """Corners (n, 6): x, y and the two neighbours on the hull; first (n + 1,), targets (e,) of the joined ones."""

    corners: Floats
    first: Ints
    targets: Ints
    raster: Raster
    radius: float


def roadmap_of(world: World, radius: float) -> Roadmap:
    """All corners of grown obstacles, joined where they see each other."""
    hulls = eroded(world.free, float(outside_arcs(radius + 2 * world.grid, QUARTER)))
    corners = _reflex_corners(hulls)
    raster = raster_of(world.edges.reshape(-1, 4).copy(), world.bounds, radius)
    pairs = _tangents(corners, raster, radius)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    first = np.searchsorted(both[:, 0], np.arange(len(corners) + 1)).astype(np.int32)
    return Roadmap(corners, first, np.ascontiguousarray(both[:, 1]), raster, radius)


def eroded(free: Polygon | MultiPolygon, distance: float) -> list[Polygon]:
    """Where a point may be that stays `distance` away from obstacles, arcs in chords between corners on the circle."""
    parts = shapely.get_parts(shapely.buffer(free, -distance, quad_segs=QUARTER))
    return [shapely.orient_polygons(part) for part in parts if not part.is_empty]


def _reflex_corners(parts: list[Polygon]) -> Floats:
    """Corners around which a way can bend, with both neighbours: (n, 6)."""
    rows = [np.empty((0, 6))]
    for part in parts:
        for ring in (part.exterior, *part.interiors):
            corners = np.asarray(ring.coords)[:-1]
            before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
            into, out = corners - before, after - corners
            bends_right = into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0] < 0
            rows.append(np.column_stack([corners, before, after])[bends_right])
    return np.concatenate(rows)


@compiled
def _touches(corner: Floats, x: float, y: float) -> bool:
    """Whether the line from a corner towards x, y leaves both neighbours on one side."""
    dx, dy = x - corner[0], y - corner[1]
    one = dx * (corner[3] - corner[1]) - dy * (corner[2] - corner[0])
    two = dx * (corner[5] - corner[1]) - dy * (corner[4] - corner[0])
    return bool(one * two >= 0)


@compiled
def sees(raster: Raster, radius: float, piece: Floats) -> bool:
    """Whether a piece (4,) keeps more than `radius` from all walls; the raster's cells on its way list those near."""
    columns, rows = raster.first.shape[0], raster.first.shape[1]
    steps = max(abs(piece[2] - piece[0]), abs(piece[3] - piece[1])) / raster.cell
    total, last_column, last_row = int(steps * 2) + 1, -1, -1
    for step in range(total + 1):
        share = step / total
        x, y = piece[0] + share * (piece[2] - piece[0]), piece[1] + share * (piece[3] - piece[1])
        column = min(max(int((x - raster.left) / raster.cell), 0), columns - 1)
        row = min(max(int((y - raster.bottom) / raster.cell), 0), rows - 1)
        if column == last_column and row == last_row:
            continue
        last_column, last_row = column, row
        begin = raster.first[column, row]
        for k in range(begin, begin + raster.counts[column, row]):
            if nearest(piece, raster.ends[raster.members[k]])[2] <= radius:
                return False
    return True


@compiled
def _tangents(corners: Floats, raster: Raster, radius: float) -> Ints:
    """Pairs (e, 2) of corners joined by a line that is tangent at both and free."""
    pairs, count, piece = np.empty((1024, 2), np.int32), 0, np.empty(4)
    for i in range(corners.shape[0]):
        for j in range(i + 1, corners.shape[0]):
            x, y, u, v = corners[i, 0], corners[i, 1], corners[j, 0], corners[j, 1]
            if _touches(corners[i], u, v) and _touches(corners[j], x, y):
                piece[0], piece[1], piece[2], piece[3] = x, y, u, v
                if sees(raster, radius, piece):
                    if count == pairs.shape[0]:
                        pairs = np.concatenate((pairs, pairs))
                    pairs[count, 0], pairs[count, 1] = i, j
                    count += 1
    return pairs[:count].copy()


@compiled
def _depart(roadmap: Roadmap, start: Floats, goal: Floats, queue: Queue, cost: Floats) -> None:
    """Queue every corner that the start may see, as state n + i: it is looked at when its turn comes."""
    total = roadmap.corners.shape[0]
    for i in range(total):
        x, y = roadmap.corners[i, 0], roadmap.corners[i, 1]
        if _touches(roadmap.corners[i], start[0], start[1]):
            cost[total + i] = np.hypot(x - start[0], y - start[1])
            push(queue, total + i, cost[total + i] + np.hypot(x - goal[0], y - goal[1]))


@compiled
def _spread(roadmap: Roadmap, i: int, goal: Floats, queue: Queue, cost: Floats, parent: Ints) -> None:
    """Queue the corners joined to corner i, and the way from it to the goal as state 2n + i."""
    x, y = roadmap.corners[i, 0], roadmap.corners[i, 1]
    if _touches(roadmap.corners[i], goal[0], goal[1]):
        push(queue, 2 * roadmap.corners.shape[0] + i, cost[i] + np.hypot(x - goal[0], y - goal[1]))
    for k in range(roadmap.first[i], roadmap.first[i + 1]):
        j = roadmap.targets[k]
        u, v = roadmap.corners[j, 0], roadmap.corners[j, 1]
        reached = cost[i] + np.hypot(u - x, v - y)
        if reached < cost[j]:
            cost[j], parent[j] = reached, i
            push(queue, j, reached + np.hypot(u - goal[0], v - goal[1]))


@compiled
def _shortest(roadmap: Roadmap, start: Floats, goal: Floats, queue: Queue) -> tuple[Ints, int]:
    """Parents of all corners, and the corner from which the goal is reached (−2: straight, −1: not at all)."""
    total = roadmap.corners.shape[0]
    cost, parent, piece = np.full(2 * total, np.inf), np.full(total, -1, np.int32), np.empty(4)
    for axis in range(2):
        piece[axis], piece[2 + axis] = start[axis], goal[axis]
    if sees(roadmap.raster, roadmap.radius, piece):
        return parent, -2
    _depart(roadmap, start, goal, queue, cost)
    while queue.size[0] > 0:
        state = pop(queue)
        i = state % total
        x, y = roadmap.corners[i, 0], roadmap.corners[i, 1]
        if state < total:
            _spread(roadmap, i, goal, queue, cost, parent)
            continue
        end = start if state < 2 * total else goal
        piece[0], piece[1], piece[2], piece[3] = x, y, end[0], end[1]
        if sees(roadmap.raster, roadmap.radius, piece):
            if state >= 2 * total:
                return parent, i
            if cost[state] < cost[i]:
                cost[i], parent[i] = cost[state], -1
                push(queue, i, cost[i] + np.hypot(x - goal[0], y - goal[1]))
    return parent, -1


def shortest(roadmap: Roadmap, start: Floats, goal: Floats) -> Floats | None:
    """The shortest way (k, 2) between two points through the roadmap, or None."""
    parent, corner = _shortest(roadmap, start, goal, queue_for(3 * len(roadmap.corners)))
    if corner == -1:
        return None
    points = [goal]
    while corner >= 0:
        points.append(roadmap.corners[corner, :2])
        corner = int(parent[corner])
    return np.array([*points, start])[::-1]
