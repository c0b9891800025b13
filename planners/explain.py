"""Why there is no path: the narrowest place on the widest way, and how much smaller the robot would have to be."""

from collections.abc import Callable

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order

from planners.path import Gap, Kind
from planners.visibility import eroded
from planners.world import World

Floats = NDArray[np.float64]
Geometries = NDArray[np.object_]

HALVINGS = 30  # of the interval that holds the radius of the largest disc
PLAY = 1e-4  # of that radius: a disc so much smaller passes, one so much larger does not; larger blurs the place


def narrowest(world: World, start: Floats, goal: Floats) -> tuple[float, Floats]:
    """Width of the widest way between two points (2,) at its narrowest, and the place (2,) where that is.

    The width is the diameter of the largest disc that can go from one point to the other.
    """
    ends = shapely.Point(start), shapely.Point(goal)
    rooms = np.array([world.free.boundary.distance(each) for each in ends])
    low, high = 0.0, float(rooms.min())
    if _part_of(world, high * (1 - 1e-9), ends[0], ends[1]) is not None:
        return 2 * high, np.asarray([start, goal][int(np.argmin(rooms))])
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        joined = _part_of(world, middle, ends[0], ends[1]) is not None
        low, high = (middle, high) if joined else (low, middle)
    joined_parts = _part_of(world, low * (1 - PLAY), ends[0], ends[1])
    if low == 0 or joined_parts is None:
        return 0.0, _between_parts(world, ends)
    return 2 * low, _neck(world, joined_parts, high, ends)


def _between_parts(world: World, ends: tuple[shapely.Point, shapely.Point]) -> Floats:
    """Where the parts of free space that hold the ends come nearest: in a wall."""
    parts = [min(world.free.geoms, key=each.distance) for each in ends]
    return np.asarray(shapely.get_coordinates(shapely.shortest_line(*parts)).mean(axis=0))


def _neck(world: World, around: shapely.Polygon, radius: float, ends: tuple[shapely.Point, shapely.Point]) -> Floats:
    """The place (2,) on a way through `around` that a disc of `radius` cannot pass.

    What that disc still reaches falls into rooms; a neck between them, not the wall where they lie closest, is the gap.
    """
    rooms = np.array(eroded(world.free, radius * (1 + PLAY)))
    reached = shapely.union_all(rooms).buffer(8 * PLAY * radius)
    necks = shapely.get_parts(around.difference(reached))
    pieces = np.concatenate([necks, shapely.get_parts(around.intersection(reached))])
    pairs = shapely.STRtree(pieces).query(pieces, predicate="dwithin", distance=0.01 * PLAY * radius)
    first, last = (int(np.argmin(shapely.distance(pieces, each))) for each in ends)
    touching = coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(len(pieces), len(pieces)))
    before, way = breadth_first_order(touching.tocsr(), first)[1], [last]
    while before[way[-1]] >= 0:
        way.append(int(before[way[-1]]))
    passed = [piece for piece in way[1:-1] if piece < len(necks)] or [piece for piece in way if piece < len(necks)]
    if not passed or pieces[passed[0]].is_empty:
        return _between_rooms(rooms, ends)
    return np.asarray(shapely.get_coordinates(pieces[passed[0]].representative_point())[0])


def _between_rooms(rooms: Geometries, ends: tuple[shapely.Point, shapely.Point]) -> Floats:
    """The neck (2,) from the first end's room to the next, where it is too short to be seen; or an end in no room."""
    first, last = (int(np.argmin(shapely.distance(rooms, each))) for each in ends)
    if first == last:
        return np.asarray(shapely.get_coordinates(max(ends, key=rooms[first].distance))[0])
    line = shapely.shortest_line(rooms[first], shapely.union_all(np.delete(rooms, first)))
    return np.asarray(shapely.get_coordinates(line).mean(axis=0))


def _part_of(world: World, radius: float, first: shapely.Point, second: shapely.Point) -> shapely.Polygon | None:
    """The part of free space for a disc that holds two points."""
    parts = eroded(world.free, radius)
    return next((part for part in parts if part.buffer(1e-6 * radius).covers(shapely.union(first, second))), None)


def walls_beside(world: World, place: Floats) -> NDArray[np.int64]:
    """The two edges (2,) between which a place lies: the nearest, and the nearest on its other side."""
    begin, along = world.edges[:, 0], world.edges[:, 1] - world.edges[:, 0]
    shares = np.einsum("ij,ij->i", place - begin, along) / np.einsum("ij,ij->i", along, along)
    away = begin + np.clip(shares, 0, 1)[:, None] * along - place
    distances = np.linalg.norm(away, axis=1)
    first = int(np.argmin(distances))
    opposite = away @ away[first] < 0
    second = int(np.argmin(np.where(opposite, distances, np.inf)))
    return np.array([first, second])


def gap_of(world: World, start: Floats, goal: Floats, needed: float) -> Gap:
    """The narrowest place on the widest way between two points (2,), with the two edges beside it."""
    width, place = narrowest(world, start, goal)
    return Gap(world.edges[walls_beside(world, place)], width, needed, place)


def largest_scale(answers: Callable[[float], Kind], low: float, steps: int) -> float:
    """The largest factor between `low` and 1 at which a smaller robot passes, within 2^−steps of the interval.

    `low` itself is known to pass, and 1 is known not to. A size too close to call is the one looked for.
    """
    high = 1.0
    for _ in range(steps):
        middle = (low + high) / 2
        kind = answers(middle)
        if kind == "undecided":
            return middle
        low, high = (middle, high) if kind == "path" else (low, middle)
    return (low + high) / 2


def gap_sentence(gap: Gap) -> str:
    """The gap in words: where, how wide, and what is needed."""
    if gap.width == 0:
        x, y = gap.place
        return f"walls part them altogether, such as the one at ({x:.2f}, {y:.2f}); needed are {gap.needed:.4g} m"
    one, two = (f"({x:.2f}, {y:.2f})" for x, y in gap.edges.mean(axis=1))
    return (
        f"between the walls at {one} and {two} the widest way is {gap.width:.4g} m wide; needed are {gap.needed:.4g} m"
    )
