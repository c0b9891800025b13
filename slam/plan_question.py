"""A question to the planners: a world, a robot that stands in it, a start and a goal.

Nothing here needs what the planners need: what is wrong with a question is told before their loops are loaded.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from frontend.scan import Floats
from planners.path import PlanningError
from planners.poses import standing
from planners.robot import Robot, parse_robot
from slam.world_file import PlanningWorld, read_world

CONES, CELLS = "cones", "configuration-space"  # the planners by name


@dataclass(frozen=True, eq=False)
class Question:
    """Where to plan, for whom, and from which pose to which: (3,) each, heading nan where any will do."""

    source: PlanningWorld
    robot: Robot
    ends: tuple[Floats, Floats]


def question_of(room: Path, layer: str, sigmas: float, robot: str, ends: tuple[str, str]) -> Question:
    """The question in words as values; `layer` and `sigmas` as for `read_world`.

    Raises RobotError, PlanningError or RoomFileError for words that say nothing, a file that holds no world, and a
    robot that cannot stand at one of the ends.
    """
    body, (start, goal) = parse_robot(robot), (parse_pose(end) for end in ends)
    source = read_world(room, layer, sigmas)
    for pose, name in ((start, "start"), (goal, "goal")):
        standing(source.world, body, pose, name)
    return Question(source, body, (start, goal))


def parse_pose(text: str) -> Floats:
    """A pose (3,) from "X,Y" or "X,Y,HEADING", metres and radians; without a heading it is nan: any will do."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError as damage:
        raise PlanningError(f"{text!r} is no X,Y[,HEADING]: {damage}") from damage
    if not np.isfinite(numbers).all():
        raise PlanningError(f"{text!r} holds a number that is not finite, but X,Y or X,Y,HEADING is needed")
    if len(numbers) not in (2, 3):
        raise PlanningError(f"{text!r} has {len(numbers)} parts, but X,Y or X,Y,HEADING is needed")
    return np.array([*numbers, np.nan][:3])
