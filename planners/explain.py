"""Why there is no path: the narrowest place on the widest way, and how much smaller the robot would have to be."""

from collections.abc import Callable

import numpy as np
import shapely
from numpy.typing import NDArray

from planners.path import Gap, Kind
from planners.visibility import eroded
from planners.world import World

Floats = NDArray[np.float64]

HALVINGS = 30  # of the interval that holds the radius of the largest disc


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
    # A part as small as a point vanishes while it is eroded: then it is the end itself.
    there, back = (_part_of(world, high, each, each) or each for each in ends)
    line = shapely.shortest_line(there, back)
    return 2 * low, shapely.get_coordinates(line).mean(axis=0)


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
    one, two = (f"({x:.2f}, {y:.2f})" for x, y in gap.edges.mean(axis=1))
    if gap.width == 0:
        return f"walls part them altogether, such as those at {one} and {two}; needed are {gap.needed:.4g} m"
    return (
        f"between the walls at {one} and {two} the widest way is {gap.width:.4g} m wide; needed are {gap.needed:.4g} m"
    )
