"""The task behind a click on the map: one planner's answer from start to goal, with the time it took."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import shapely
from shapely import LineString, MultiPolygon, box

from frontend.scan import Floats
from planners.path import Answer
from planners.robot import Robot, parse_robot
from planners.world import World
from slam.planning import PLANNERS, PlanningSettings, answer_values
from slam.result_folder import plain
from slam.room_file import free_space

LAYER = "safety"
ANYWHERE = np.nan  # a heading that is left to the planner


@dataclass(frozen=True)
class Question:
    """Who wants to go where: x and y in metres, the robot as `planners.robot` reads it, the planner by name."""

    planner: str
    robot: str
    start: tuple[float, float]
    goal: tuple[float, float]


def route(map_file: Path, question: Question) -> Iterator[dict[str, Any]]:
    """The planner's answer as JSON holds it. Raises PlanningError, RobotError or RoomFileError."""
    robot, world = parse_robot(question.robot), _world(map_file, map_file.stat().st_mtime_ns)
    _warmed(question.planner)
    clock = perf_counter()
    answer = _ask(question.planner, world, robot, np.array(question.start), np.array(question.goal))
    seconds = perf_counter() - clock
    yield plain({**answer_values(answer), "seconds": seconds, **_drawable(answer), "outline": _outline(robot)})


def _ask(planner: str, world: World, robot: Robot, start: Floats, goal: Floats) -> Answer:
    ends = [np.array([*place, ANYWHERE]) for place in (start, goal)]
    return PLANNERS[planner](world, robot, ends[0], ends[1], PlanningSettings())


@lru_cache(maxsize=4)
def _world(map_file: Path, _written: int) -> World:
    """The world on a map, made once for all questions about it."""
    return World.from_free_space(free_space(map_file, LAYER)[0])


@lru_cache(maxsize=len(PLANNERS))
def _warmed(planner: str) -> None:
    """Have the planner's compiled loops loaded, so that the time of its first answer is that of planning."""
    room = World.from_free_space(MultiPolygon([box(0, 0, 4, 4)]))
    _ask(planner, room, Robot.disc(0.2), np.array([1.0, 1.0]), np.array([3.0, 3.0]))


def _drawable(answer: Answer) -> dict[str, Any]:
    """What shows how the planner thought: the spines it drove along, and the gap that is too narrow."""
    gap = None
    if answer.gap is not None:
        narrowest = shapely.shortest_line(*(LineString(edge) for edge in answer.gap.edges))
        gap = {
            "edges": answer.gap.edges.tolist(),
            "narrowest": shapely.get_coordinates(narrowest).tolist(),
            "width": answer.gap.width,
            "needed": answer.gap.needed,
        }
    return {"spines": [cone.spine.tolist() for cone in answer.cones], "gap": gap}


def _outline(robot: Robot) -> dict[str, Any]:
    return {"parts": [part.tolist() for part in robot.parts], "radius": robot.radius}
