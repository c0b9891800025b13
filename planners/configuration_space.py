"""Paths through configuration space, guaranteed at a resolution (Brooks & Lozano-Pérez 1985; Flynn 1988, §4.3).

Polygon robots search boxes of (x, y, heading), discs an exact roadmap. Both answer with a path that is proved free, or
with the proof that there is none and the gap that is too narrow, or with "undecided" and the resolution.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from planners.box_space import BoxSpace, ConfigurationSpaceSettings, prepare_boxes, query_boxes
from planners.disc_space import DiscSpace, prepare_disc, query_disc
from planners.explain import gap_of, gap_sentence, largest_scale
from planners.path import Answer, Gap, Kind
from planners.poses import Pose, standing
from planners.robot import Robot
from planners.world import World

__all__ = ["ConfigurationSpace", "ConfigurationSpaceSettings", "plan", "prepare", "query"]

Floats = NDArray[np.float64]


ConfigurationSpace = BoxSpace | DiscSpace


def plan(world: World, robot: Robot, start: Pose, goal: Pose, settings: ConfigurationSpaceSettings) -> Answer:
    """A path of `robot` in `world` from `start` to `goal` (3,), or the proof that there is none."""
    return query(prepare(world, robot, settings), start, goal)


def prepare(world: World, robot: Robot, settings: ConfigurationSpaceSettings) -> ConfigurationSpace:
    """What many queries share."""
    if robot.is_disc:
        return prepare_disc(world, robot, settings)
    return prepare_boxes(world, robot, settings)


def query(space: ConfigurationSpace, start: Pose, goal: Pose) -> Answer:
    """A path from `start` to `goal` (3,) with a heading, nan or None for any; or the proof that there is none.

    Raises PlanningError where the robot cannot stand.
    """
    body = space.robot.grown(space.settings.clearance)
    begin, end = standing(space.world, body, start, "start"), standing(space.world, body, goal, "goal")
    answer = query_disc(space, begin, end) if isinstance(space, DiscSpace) else query_boxes(space, begin, end)
    return _explained(space, answer, begin, end) if answer.kind == "no path" else answer


def _explained(space: ConfigurationSpace, answer: Answer, start: Floats, goal: Floats) -> Answer:
    """The answer with the gap that is too narrow.

    A gap below the robot's width stops it at every heading. In a wider one it is the turn that fails: what is needed
    is then the gap over the largest scale at which the robot passes.
    """
    straight = space.robot.width + 2 * space.settings.clearance
    gap = gap_of(space.world, start[:2], goal[:2], straight)
    if gap.width >= straight and space.settings.smaller_robots:
        gap = replace(gap, needed=gap.width / _passing_scale(space, gap, start, goal))
    return replace(answer, gap=gap, reason=f"{answer.reason}: {gap_sentence(gap)}")


def _passing_scale(space: ConfigurationSpace, gap: Gap, start: Floats, goal: Floats) -> float:
    settings = replace(space.settings, shortcuts=0)

    def answers(scale: float) -> Kind:
        smaller = prepare_boxes(space.world, space.robot.scaled(scale), settings)
        return query_boxes(smaller, start, goal).kind

    enclosing = 2 * (space.robot.reach + space.settings.clearance)
    return largest_scale(answers, min(gap.width / enclosing, 1.0), settings.smaller_robots)
