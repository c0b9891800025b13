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

from planners.compiled import compiled, kernel
from planners.orientations import nearest
from planners.raster import Raster, raster_of
from planners.state_queue import Queue, pop, push, queue_for
from planners.world import World, outside_arcs

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

QUARTER = 16  # chords in a quarter circle: the hull stands off by 0.3 % of the radius at most
SMOOTHED = 0.01  # of the distance: how far GEOS's buffer may pass by a shallow corner, on the side of less free space


class Roadmap(NamedTuple):
    """Corners (n, 6): x, y and the two neighbours on the hull; first (n + 1,), targets (e,) of the joined ones and
    how far they are, lengths (e,)."""

    corners: Floats
    first: Ints
    targets: Ints
    lengths: Floats
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
    lengths = np.linalg.norm(corners[both[:, 0], :2] - corners[both[:, 1], :2], axis=1)
    return Roadmap(corners, first, np.ascontiguousarray(both[:, 1]), lengths, raster, radius)


def eroded(free: Polygon | MultiPolygon, distance: float) -> list[Polygon]:
    """Where a point may be that stays `distance` away from obstacles, arcs in chords between corners on the circle."""
    parts = shapely.get_parts(shapely.buffer(free, -distance, quad_segs=QUARTER))
    return [shapely.orient_polygons(part) for part in parts if not part.is_empty]


def parted(world: World, radius: float, start: Floats, goal: Floats) -> bool:
    """Whether no disc of that radius comes from one point (2,) to the other, not even among hulls a bit too small."""
    points = shapely.points([start, goal])
    parts = eroded(world.free, (1 - SMOOTHED) * radius - 8 * world.grid)
    return not any(shapely.covers(part.buffer(8 * world.grid), points).all() for part in parts)


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


@kernel
def _touches(corner: Floats, x: float, y: float) -> bool:
    """Whether the line from a corner towards x, y leaves both neighbours on one side."""
    dx, dy = x - corner[0], y - corner[1]
    one = dx * (corner[3] - corner[1]) - dy * (corner[2] - corner[0])
    two = dx * (corner[5] - corner[1]) - dy * (corner[4] - corner[0])
    return bool(one * two >= 0)


@kernel
def _strays(frame: Floats, wall: Floats, radius: float) -> bool:
    """Whether a wall (4,) lies wholly to one side of a piece, or before or behind it, by more than `radius`.

    frame: (5,) start of the piece, its unit direction and its length.
    """
    x0, y0, x1, y1 = wall[0] - frame[0], wall[1] - frame[1], wall[2] - frame[0], wall[3] - frame[1]
    one, two = frame[2] * y0 - frame[3] * x0, frame[2] * y1 - frame[3] * x1
    if min(one, two) > radius or max(one, two) < -radius:
        return True
    one, two = frame[2] * x0 + frame[3] * y0, frame[2] * x1 + frame[3] * y1
    return bool(max(one, two) < -radius or min(one, two) > frame[4] + radius)


@kernel
def sees(raster: Raster, radius: float, piece: Floats) -> bool:
    """Whether a piece (4,) keeps more than `radius` from all walls; the raster's cells on its way list those near."""
    columns, rows = raster.first.shape[0], raster.first.shape[1]
    frame = np.empty(5)
    frame[0], frame[1], frame[2], frame[3] = piece[0], piece[1], piece[2] - piece[0], piece[3] - piece[1]
    total = int(2 * max(abs(frame[2]), abs(frame[3])) / raster.cell) + 1
    step_x, step_y = frame[2] / (total * raster.cell), frame[3] / (total * raster.cell)
    frame[4] = np.sqrt(frame[2] * frame[2] + frame[3] * frame[3])
    frame[2], frame[3] = frame[2] / max(frame[4], 1e-300), frame[3] / max(frame[4], 1e-300)
    begin_x, begin_y = (piece[0] - raster.left) / raster.cell, (piece[1] - raster.bottom) / raster.cell
    last = -1
    for step in range(total + 1):
        column = min(max(int(begin_x + step * step_x), 0), columns - 1)
        row = min(max(int(begin_y + step * step_y), 0), rows - 1)
        if column * rows + row == last:
            continue
        last = column * rows + row
        for k in range(raster.first[column, row], raster.first[column, row] + raster.counts[column, row]):
            wall = raster.ends[raster.members[k]]
            if not _strays(frame, wall, radius) and nearest(piece, wall)[2] <= radius:
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


@kernel
def _distance(x: float, y: float, point: Floats) -> float:
    return float(np.sqrt((x - point[0]) ** 2 + (y - point[1]) ** 2))


@kernel
def _depart(roadmap: Roadmap, ends: Floats, queue: Queue, cost: Floats) -> None:
    """Queue every corner that the start may see, as state n + i: it is looked at when its turn comes."""
    total, start, goal = roadmap.corners.shape[0], ends[0], ends[1]
    for i in range(total):
        x, y = roadmap.corners[i, 0], roadmap.corners[i, 1]
        if _touches(roadmap.corners[i], start[0], start[1]):
            cost[total + i] = _distance(x, y, start)
            push(queue, total + i, cost[total + i] + _distance(x, y, goal))


@kernel
def _wraps(corner: Floats, before: Floats, x: float, y: float) -> bool:
    """Whether a way from `before` bends at a corner towards the hull on its way to x, y, as a taut string does."""
    dx, dy = corner[0] - before[0], corner[1] - before[1]
    hull = dx * (corner[3] + corner[5] - 2 * corner[1]) - dy * (corner[2] + corner[4] - 2 * corner[0])
    bend = dx * (y - corner[1]) - dy * (x - corner[0])
    slack = 1e-9 * (abs(dx) + abs(dy)) * (abs(x - corner[0]) + abs(y - corner[1]))
    return bool(bend >= -slack if hull >= 0 else bend <= slack)


@kernel
def _leave(roadmap: Roadmap, i: int, ends: Floats, queue: Queue, cost: Floats, parent: Ints) -> None:
    """Queue the way from corner i to the goal, state 2n + i, if it is taut. ends: (2, 2) start and goal."""
    corner, goal = roadmap.corners[i], ends[1]
    before = roadmap.corners[parent[i]] if parent[i] >= 0 else ends[0]
    if _touches(corner, goal[0], goal[1]) and _wraps(corner, before, goal[0], goal[1]):
        push(queue, 2 * roadmap.corners.shape[0] + i, cost[i] + _distance(corner[0], corner[1], goal))


@kernel
def _spread(roadmap: Roadmap, i: int, ends: Floats, queue: Queue, cost: Floats, parent: Ints) -> None:
    """Queue the corners joined to corner i: only taut ways are followed, for no other begins a shortest one.

    A corner with two neighbours only is passed at once, unless the goal may be seen from it.
    """
    corner, goal = roadmap.corners[i], ends[1]
    before = roadmap.corners[parent[i]] if parent[i] >= 0 else ends[0]
    for k in range(roadmap.first[i], roadmap.first[i + 1]):
        last, j, reached = i, roadmap.targets[k], cost[i] + roadmap.lengths[k]
        if not _wraps(corner, before, roadmap.corners[j, 0], roadmap.corners[j, 1]):
            continue
        while reached < cost[j]:
            cost[j], parent[j] = reached, last
            begin = roadmap.first[j]
            if roadmap.first[j + 1] - begin != 2 or _touches(roadmap.corners[j], goal[0], goal[1]):
                push(queue, j, reached + _distance(roadmap.corners[j, 0], roadmap.corners[j, 1], goal))
                break
            onward = begin if roadmap.targets[begin] != last else begin + 1
            last, j, reached = j, roadmap.targets[onward], reached + roadmap.lengths[onward]


@compiled
def _shortest(roadmap: Roadmap, ends: Floats, queue: Queue) -> tuple[Ints, int]:
    """Parents of all corners, and the corner from which the goal is reached (−2: straight, −1: not at all).

    ends: (2, 2) start and goal.
    """
    total = roadmap.corners.shape[0]
    cost, parent, piece = np.full(2 * total, np.inf), np.full(total, -1, np.int32), ends.copy().reshape(4)
    if sees(roadmap.raster, roadmap.radius, piece):
        return parent, -2
    _depart(roadmap, ends, queue, cost)
    while queue.size[0] > 0:
        state = pop(queue)
        i = state % total
        x, y = roadmap.corners[i, 0], roadmap.corners[i, 1]
        if state < total:
            _leave(roadmap, i, ends, queue, cost, parent)
            _spread(roadmap, i, ends, queue, cost, parent)
            continue
        end = ends[state // total - 1]
        piece[0], piece[1], piece[2], piece[3] = x, y, end[0], end[1]
        if sees(roadmap.raster, roadmap.radius, piece):
            if state >= 2 * total:
                return parent, i
            if cost[state] < cost[i]:
                cost[i], parent[i] = cost[state], -1
                push(queue, i, cost[i] + _distance(x, y, ends[1]))
    return parent, -1


def shortest(roadmap: Roadmap, start: Floats, goal: Floats) -> Floats | None:
    """The shortest way (k, 2) between two points through the roadmap, or None."""
    parent, corner = _shortest(roadmap, np.stack([start, goal]), queue_for(3 * len(roadmap.corners)))
    if corner == -1:
        return None
    points = [goal]
    while corner >= 0:
        points.append(roadmap.corners[corner, :2])
        corner = int(parent[corner])
    return np.array([*points, start])[::-1]
