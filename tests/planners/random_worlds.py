"""Random worlds, robots and poses, with what breaks planners: touching walls, slits, collinear edges, needles."""

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon, box

from planners.robot import Robot
from planners.world import World

Floats = NDArray[np.float64]

SIDE = 100.0


def _rectangle(middle: Floats, size: Floats, angle: float) -> Floats:
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * size / 2
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(corners @ np.array([[cosine, sine], [-sine, cosine]]) + middle)


def chain(rng: np.random.Generator) -> list[Polygon]:
    """A wall of thin linked rectangles that touch end to end."""
    start, angle = rng.uniform(0, SIDE, 2), rng.choice([0.0, np.pi / 2, rng.uniform(0, np.pi)])
    along = np.array([np.cos(angle), np.sin(angle)])
    return [Polygon(_rectangle(start + 9 * k * along, np.array([9.0, 1.0]), angle)) for k in range(rng.integers(3, 9))]


def slit(rng: np.random.Generator) -> list[Polygon]:
    """Two blocks with a gap that may be real, hair-thin, closed or overlapping."""
    gap = float(rng.choice([6.0, 0.5, 1e-4, 1e-9, 0.0, -1e-9, -0.3]))
    middle, angle, size = rng.uniform(15, SIDE - 15, 2), rng.uniform(0, np.pi), rng.uniform(5, 25)
    along = np.array([np.cos(angle), np.sin(angle)]) * (size + gap) / 2
    return [Polygon(_rectangle(middle + sign * along, np.array([size, 4.0]), angle)) for sign in (-1, 1)]


def needle(rng: np.random.Generator) -> list[Polygon]:
    """A triangle as thin as a hair, or with no area at all."""
    start, angle = rng.uniform(0, SIDE, 2), rng.uniform(0, 2 * np.pi)
    along, width = np.array([np.cos(angle), np.sin(angle)]), float(rng.choice([0.2, 1e-6, 0.0]))
    end = start + along * rng.uniform(5, 30)
    return [Polygon([start, end, end + width * np.array([-along[1], along[0]])])]


def block(rng: np.random.Generator) -> list[Polygon]:
    """A block with collinear corners, now and then crossing itself."""
    corners = _rectangle(rng.uniform(0, SIDE, 2), rng.uniform(3, 25, 2), rng.uniform(0, np.pi))
    if rng.random() < 0.15:
        corners = corners[[0, 2, 1, 3]]
    middles = (corners + np.roll(corners, -1, axis=0)) / 2
    return [Polygon(np.stack([corners, middles], axis=1).reshape(-1, 2))]


def random_obstacles(rng: np.random.Generator) -> list[Polygon]:
    """A handful of each kind."""
    kinds = (chain, slit, needle, block)
    return [polygon for kind in kinds for _ in range(rng.integers(1, 5)) for polygon in kind(rng)]


def random_world(rng: np.random.Generator) -> World:
    """A square world of side 100 with random obstacles."""
    return World.from_obstacles(box(0, 0, SIDE, SIDE), random_obstacles(rng))


def random_robot(rng: np.random.Generator) -> Robot:
    """A disc, a rectangle, a triangle or an L."""
    size = rng.uniform(1.5, 6)
    match rng.integers(4):
        case 0:
            return Robot.disc(size / 2)
        case 1:
            return Robot.rectangle(2 * size, size)
        case 2:
            return Robot.polygons(size * np.array([[-0.7, -0.5], [1.2, 0.0], [-0.7, 0.6]]))
        case _:
            return Robot.polygons(size * np.array([[0, 0], [1.5, 0], [1.5, 0.5], [0.5, 0.5], [0.5, 1.5], [0, 1.5]]))


def random_pose(rng: np.random.Generator, world: World, robot: Robot) -> Floats | None:
    """A pose where the robot stands free, now and then with a free heading; None if a hundred tries found none."""
    for _ in range(100):
        pose = np.append(rng.uniform(0, SIDE, 2), rng.uniform(-np.pi, np.pi))
        if shapely.covers(world.free, robot.grown(1e-6).at(pose)):
            return pose
    return None
