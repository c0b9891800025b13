"""Planning on a room: both planners by name, and their answers as plain values."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon

from frontend.scan import Floats
from planners import configuration_space, generalized_cones
from planners.configuration_space import ConfigurationSpaceSettings
from planners.generalized_cones import ConesSettings
from planners.path import Answer, Path, PlanningError
from planners.robot import Robot, parse_robot
from planners.world import World, WorldError
from slam.plan_question import CELLS, CONES


@dataclass(frozen=True)
class PlanningSettings:
    """The settings of both planners, and of the drive that merge plans on every new map."""

    cones: ConesSettings = field(default_factory=ConesSettings)
    configuration_space: ConfigurationSpaceSettings = field(default_factory=ConfigurationSpaceSettings)
    tour_robot: str = "disc:0.15"  # who goes from the first pose to the map's end; larger fits through fewer doors
    tour_room: float = 1.0  # radii of that robot left around it at the end; larger stops farther from the walls


Planner = Callable[[World, Robot, Floats, Floats, PlanningSettings], Answer]

PLANNERS: dict[str, Planner] = {
    CONES: lambda world, robot, start, goal, settings: generalized_cones.plan(
        world, robot, start, goal, settings.cones
    ),
    CELLS: lambda world, robot, start, goal, settings: configuration_space.plan(
        world, robot, start, goal, settings.configuration_space
    ),
}


def tour(safety: MultiPolygon, start: Floats, settings: PlanningSettings) -> dict[str, Answer]:
    """Each planner's way from `start` (3,) to the far end of the same part of the map, headings free.

    Raises PlanningError where the robot cannot stand at the start.
    """
    robot = parse_robot(settings.tour_robot)
    # A little more than the robot, for a rounded corner of the eroded layer lies inside the true curve.
    standable = shapely.get_parts(safety.buffer(-1.05 * robot.reach))
    around = [part for part in standable if shapely.contains_xy(part, *start[:2])]
    if not around:
        raise PlanningError(
            f"a robot {settings.tour_robot} cannot stand at the first pose ({start[0]:.2f}, {start[1]:.2f})"
        )
    goal = _far_end(around[0], settings.tour_room * robot.reach, start)
    begin, end, world = np.array([*start[:2], np.nan]), np.array([*goal, np.nan]), World.from_free_space(safety)
    return {name: planner(world, robot, begin, end, settings) for name, planner in PLANNERS.items()}


def _far_end(around: Polygon, room: float, start: Floats) -> Floats:
    """The place (2,) farthest from `start` with `room` metres between it and the end of `around`, if any has it."""
    roomy = around.buffer(-room)
    corners = shapely.get_coordinates(around if roomy.is_empty else roomy)
    return np.asarray(corners[np.argmax(np.linalg.norm(corners - start[:2], axis=1))])


def tour_or_reason(
    safety: MultiPolygon, start: Floats, settings: PlanningSettings
) -> tuple[dict[str, Answer], str | None]:
    """The tour's answers, or none of them and the reason: a map that nobody can drive on is still a map."""
    try:
        return tour(safety, start, settings), None
    except (PlanningError, WorldError) as reason:
        return {}, str(reason)


def paths_text(answers: dict[str, Answer]) -> str:
    """The paths of those planners that found one, as GeoJSON: lines, with heading, length and clearance beside them."""
    features = [_path_feature(answer.path, name) for name, answer in answers.items() if answer.path is not None]
    return json.dumps({"type": "FeatureCollection", "features": features}) + "\n"


def _path_feature(path: Path, planner: str) -> dict[str, Any]:
    properties = {
        "kind": "path",
        "planner": planner,
        "length": path.length,
        "clearance": path.clearance,
        "turning": path.turning,
        "headings": path.poses[:, 2].tolist(),
        "certificate": path.certificate,
    }
    line = {"type": "LineString", "coordinates": path.poses[:, :2].tolist()}
    return {"type": "Feature", "properties": properties, "geometry": line}


def answer_values(answer: Answer) -> dict[str, Any]:
    """The answer as JSON holds it: metres, radians, null where there is no path."""
    path = answer.path
    return {
        "answer": answer.kind,
        "length": None if path is None else path.length,
        "clearance": None if path is None else path.clearance,
        "poses": [] if path is None else path.poses.tolist(),
        "reason": answer.reason,
    }
