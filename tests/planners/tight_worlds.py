"""Two halls and one passage between them that is a hair wider or narrower than the robot: slanted, round or curved.

Whether the robot passes is known by construction: between parallel walls and between two convex bodies whose nearest
corners lie opposite each other any robot that is narrower than the gap, round a bend a disc.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon, box
from shapely.affinity import rotate, translate

from planners.robot import Robot
from planners.world import World

Floats = NDArray[np.float64]
Passage = Callable[[np.random.Generator, float], list[shapely.Geometry]]

LONG, HIGH = 30.0, 15.0  # half the sides of both halls together
WALL = 0.1  # half a thin wall


@dataclass(frozen=True, eq=False)
class Tight:
    """A world, a robot, start and goal (3,), and by how much the passage is wider than the robot, as a share of it."""

    world: World
    robot: Robot
    start: Floats
    goal: Floats
    spare: float


def straight(rng: np.random.Generator, width: float) -> list[shapely.Geometry]:
    """Parallel walls."""
    half = rng.uniform(0.1, 6)
    return [box(-half, width / 2, half, HIGH + 1), box(-half, -HIGH - 1, half, -width / 2)]


def columns(rng: np.random.Generator, width: float) -> list[shapely.Geometry]:
    """Two round columns of many sides, each tied to the wall behind it."""
    solids: list[shapely.Geometry] = []
    for side in (1, -1):
        round_about = polygon(rng.uniform(0.5, 4), int(rng.integers(3, 60)), rng.uniform(0, 7))
        corners = side * shapely.get_coordinates(round_about)
        tip = corners[np.argmin(side * corners[:, 1])]
        column = translate(Polygon(corners), -tip[0], side * width / 2 - tip[1])
        x, y = column.centroid.x, column.centroid.y
        solids += [column, box(x - WALL, min(y, side * (HIGH + 1)), x + WALL, max(y, side * (HIGH + 1)))]
    return solids


def bend(rng: np.random.Generator, width: float) -> list[shapely.Geometry]:
    """Half a turn between an inner and an outer wall of many sides; below, a thin wall parts the halls."""
    sides, inner = 4 * int(rng.integers(2, 30)), rng.uniform(1, 5)
    upper = box(-LONG - 1, 0, LONG + 1, HIGH + 1)
    # Corners of the inner wall on a circle, sides of the outer one on a wider circle: nowhere nearer than `width`.
    core = polygon(inner, sides, 0.0)
    shell = polygon((inner + width) / np.cos(np.pi / sides), sides, np.pi / sides)
    return [upper.difference(shell), core.intersection(upper), box(-WALL, -HIGH - 1, WALL, WALL)]


def polygon(radius: float, sides: int, turn: float) -> Polygon:
    """A regular polygon about the origin."""
    angles = turn + np.arange(sides) * 2 * np.pi / sides
    return Polygon(radius * np.column_stack([np.cos(angles), np.sin(angles)]))


PASSAGES: tuple[Passage, ...] = (straight, columns, bend)


def tight(rng: np.random.Generator, passage: Passage, most: float) -> Tight:
    """A passage up to the share `most` wider or narrower than a random robot, turned any way."""
    width, spare, turn = rng.uniform(0.4, 3), rng.uniform(-most, most), rng.uniform(0, 360)
    is_disc = passage is bend or rng.random() < 0.5
    robot = Robot.disc(width / 2) if is_disc else Robot.rectangle(width * rng.uniform(1.2, 2.5), width)
    solids = [rotate(solid, turn, origin=(0, 0)) for solid in passage(rng, width * (1 + spare))]
    hall = rotate(box(-LONG, -HIGH, LONG, HIGH), turn, origin=(0, 0))
    cosine, sine = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    ends = np.array([[-20.0, -6.0], [20.0, -6.0]]) @ np.array([[cosine, sine], [-sine, cosine]])
    start, goal = (np.array([*end, rng.choice([np.nan, rng.uniform(0, 6)])]) for end in ends)
    return Tight(World.from_obstacles(hall, solids), robot, start, goal, spare)
