"""Where a robot can stand: start and goal checked before any planning."""

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from planners.path import PlanningError
from planners.robot import Robot
from planners.world import World

Floats = NDArray[np.float64]
Pose = Floats | Sequence[float | None]


def standing(world: World, robot: Robot, pose: Pose, name: str) -> Floats:
    """`pose` as (3,) with its heading in [0, 2π), or nan where any heading will do.

    Raises PlanningError, with `name` and the depth in metres, if the robot overlaps an obstacle there; with a free
    heading only the reference point is checked.
    """
    checked = np.array(pose, dtype=float)
    if checked.shape != (3,) or not np.isfinite(checked[:2]).all() or np.isinf(checked[2]):
        raise PlanningError(f"{name} needs x, y and a heading (or none), but is {pose}")
    checked[2] %= 2 * np.pi
    place = f"{name} ({checked[0]:g}, {checked[1]:g})"
    point = shapely.Point(checked[:2])
    if not world.free.covers(point):
        enclosed = any(shapely.Polygon(part.exterior).covers(point) for part in world.free.geoms)
        where = "in an obstacle" if enclosed else "where no wall encloses it"
        raise PlanningError(f"{place} lies {world.free.distance(point):.3g} m outside of free space, {where}")
    if robot.is_disc:
        room = float(shapely.distance(world.boundary, point))
        if room <= robot.radius:
            raise PlanningError(
                f"{place} has {room:.3g} m to the nearest obstacle, but the robot needs {robot.radius:g}"
            )
    elif np.isfinite(checked[2]):
        _check_outline(world, robot, checked, place)
    return checked


def _check_outline(world: World, robot: Robot, pose: Floats, place: str) -> None:
    outside = shapely.difference(robot.at(pose), world.free)
    if not outside.is_empty:
        depth = shapely.distance(shapely.points(shapely.get_coordinates(outside)), world.free).max()
        degrees = round(np.degrees(pose[2])) % 360
        raise PlanningError(f"{place} at {degrees}° overlaps an obstacle: the robot reaches {depth:.3g} m into it")
