"""Paths through configuration space, guaranteed at a resolution (Brooks & Lozano-Pérez 1985; Flynn 1988, §4.3).

The space of (x, y, heading) is cut into boxes only where the best channel needs it. The answer is a path whose whole
continuous motion is proved free, a proof that there is none, or "undecided" at the stated resolution.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planners.cells import EMPTY, MIXED, SMALL, SPLIT, Walls
from planners.channels import EXHAUSTED, FOUND, Front, Query, front_for, refine, search
from planners.outline import Outline, outline_of
from planners.path import Answer, Cells, Path
from planners.poses import Pose, standing
from planners.robot import Robot
from planners.state_queue import Queue, queue_for
from planners.subdivision import CELLS, Tree, plant
from planners.world import World

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ConfigurationSpaceSettings:
    """Opinions of the configuration-space planner."""

    resolution: float = 0.02  # metres; smaller finds paths of less clearance (all above 2.42 of it) and takes longer
    mixed_cost: float = 3.0  # per metre through a box not known; larger settles for longer detours sooner
    turn_cost: float = 0.1  # metres per radian; larger avoids turning
    levels: int = 3  # halvings between two searches; larger searches less often and cuts more
    most_boxes: int = 400_000  # larger goes on longer, at 1 kB a box, before answering "undecided"


@dataclass(frozen=True, eq=False)
class ConfigurationSpace:
    """A world prepared for one robot; the boxes of earlier queries serve later ones."""

    world: World
    robot: Robot
    settings: ConfigurationSpaceSettings
    outline: Outline
    walls: Walls
    tree: Tree
    front: Front
    queue: Queue


def plan(world: World, robot: Robot, start: Pose, goal: Pose, settings: ConfigurationSpaceSettings) -> Answer:
    """A path of `robot` in `world` from `start` to `goal` (3,), or the proof that there is none."""
    return query(prepare(world, robot, settings), start, goal)


def prepare(world: World, robot: Robot, settings: ConfigurationSpaceSettings) -> ConfigurationSpace:
    """What many queries share."""
    outline, walls = outline_of(robot), Walls(world.edges.reshape(-1, 4).copy(), world.grid)
    left, bottom, right, top = world.bounds
    frame = np.array([[left, bottom, 0.0], [right, top, 2 * np.pi / robot.symmetry]])
    tree = plant(outline, outline, walls, frame, (robot.reach, settings.resolution, settings.most_boxes))
    front = front_for(tree, robot.symmetry)
    return ConfigurationSpace(world, robot, settings, outline, walls, tree, front, queue_for(len(front.cost)))


def query(space: ConfigurationSpace, start: Pose, goal: Pose) -> Answer:
    """A path from `start` to `goal` (3,) with a heading, nan or None for any; or the proof that there is none."""
    ends = standing(space.world, space.robot, start, "start"), standing(space.world, space.robot, goal, "goal")
    asked = _asked(space, *ends)
    space.front.seen[:], space.front.closed[:] = 0, 0
    outlines = (space.outline, space.outline)
    status, last, searches = refine(space.tree, outlines, space.walls, asked, space.front, space.queue)
    if status == FOUND:
        poses = _poses(space, asked, last)
        path = Path(poses, 0.0, "every piece lies in a box of configuration space that is free throughout")
        return Answer("path", "a path through free boxes was found", path, cells=_cells(space.tree))
    if status == EXHAUSTED:
        reason = f"all {space.settings.most_boxes} boxes are used up"
        return Answer("undecided", reason, cells=_cells(space.tree))
    asked.factors[SMALL] = 1.0
    if search(space.tree, asked, space.front, space.queue, searches + 1) >= 0:
        reason = f"start and goal are joined only by boxes of {space.settings.resolution:g} m that are partly free"
        return Answer("undecided", reason, cells=_cells(space.tree))
    return Answer("no path", "boxes that collide throughout separate start and goal", cells=_cells(space.tree))


def _asked(space: ConfigurationSpace, start: Floats, goal: Floats) -> Query:
    factors = np.full(5, np.inf)
    factors[EMPTY], factors[MIXED] = 1.0, space.settings.mixed_cost
    sheets, levels, turn_cost = space.robot.symmetry, space.settings.levels, space.settings.turn_cost
    return Query(start, goal, sheets, 2 * np.pi / sheets, factors, turn_cost, levels)


def _poses(space: ConfigurationSpace, asked: Query, last: int) -> Floats:
    """The motion (p, 3) from start through the entry points of its boxes to the goal, headings unwrapped."""
    entries, state = [asked.goal], last
    while state >= 0:
        entries.append(space.front.entry[state].copy())
        state = int(space.front.parent[state])
    poses = np.array(entries[::-1])
    if np.isnan(poses[-1, 2]):
        poses[-1, 2] = poses[-2, 2]
    poses[:, 2] = np.unwrap(poses[:, 2], period=asked.period)
    if np.isfinite(asked.start[2]):
        poses[:, 2] += asked.start[2] - poses[0, 2]
    return poses


def _cells(tree: Tree) -> Cells:
    """The boxes that were not cut further."""
    made = slice(0, int(tree.used[CELLS]))
    kept = tree.labels[made] != SPLIT
    return Cells(tree.lows[made][kept], tree.highs[made][kept], tree.labels[made][kept])
