"""Configuration space of a disc: heading makes no difference, so the exact shortest way is at hand."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from planners.box_space import ConfigurationSpaceSettings
from planners.path import Answer, Path
from planners.robot import Robot
from planners.visibility import Roadmap, parted, roadmap_of, shortest
from planners.world import World

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DiscSpace:
    """A world prepared for one disc. radius: the robot's and the clearance that is asked for."""

    world: World
    robot: Robot
    settings: ConfigurationSpaceSettings
    roadmap: Roadmap
    radius: float


def prepare_disc(world: World, robot: Robot, settings: ConfigurationSpaceSettings) -> DiscSpace:
    """The roadmap that all queries share."""
    shapely.prepare(world.boundary)
    radius = robot.radius + settings.clearance
    return DiscSpace(world, robot, settings, roadmap_of(world, radius), radius)


def query_disc(space: DiscSpace, start: Floats, goal: Floats) -> Answer:
    """The shortest path between poses (3,), headings in [0, 2π) or nan; turning is done on the way."""
    points = shortest(space.roadmap, start[:2], goal[:2])
    if points is not None:
        poses = _headed(points, start[2], goal[2])
        nearest = float(shapely.distance(space.world.boundary, shapely.linestrings(points)))
        clearance = max(nearest - space.robot.radius, space.settings.clearance)
        certificate = "every piece keeps more than the radius from every wall"
        return Answer("path", f"the shortest path, by {len(points) - 2} corners", Path(poses, clearance, certificate))
    if not parted(space.world, space.radius, start[:2], goal[:2]):
        reason = f"a passage is within 1 % of the radius of {space.radius:g} m: too close to call"
        return Answer("undecided", reason)
    return Answer("no path", f"places with {space.radius:g} m of room around them do not join start and goal")


def _headed(points: Floats, first: float, last: float) -> Floats:
    """Poses (k, 3) that turn evenly on the way, the short way round; a free heading takes the other's."""
    first = first if np.isfinite(first) else last if np.isfinite(last) else 0.0
    turn = (last - first + np.pi) % (2 * np.pi) - np.pi if np.isfinite(last) else 0.0
    travelled = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return np.column_stack([points, first + turn * travelled / max(travelled[-1], np.finfo(float).tiny)])
