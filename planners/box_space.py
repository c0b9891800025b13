"""Configuration space of a polygon robot, cut into boxes only where the best channel needs it.

The answer is a path whose whole continuous motion is proved free, a proof that there is none, or "undecided" at the
stated resolution.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planners.cells import EMPTY, FULL, MIXED, SMALL, SPLIT, Walls
from planners.channels import EVERYWHERE, EXHAUSTED, FOUND, Front, Query, forget, front_for, refine, search
from planners.guide import guide_to
from planners.mooring import moored
from planners.motion import Course, clearance_of, course_of
from planners.outline import Outline, outline_of
from planners.path import Answer, Cells, Path
from planners.robot import CHORDS, Robot
from planners.shortcut import shortened
from planners.state_queue import Queue, queue_for
from planners.subdivision import CELLS, Tree, plant
from planners.visibility import parted
from planners.world import World, outside_arcs

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ConfigurationSpaceSettings:
    """Opinions of the configuration-space planner."""

    clearance: float = 0.0  # metres kept from every obstacle; larger is safer, longer, and passes fewer doors
    resolution: float = 0.02  # metres; smaller finds paths of less clearance (all above 2.42 of it) and takes longer
    mixed_cost: float = 1.7  # per metre through a box not known; larger settles for longer detours sooner
    turn_cost: float = 0.1  # metres per radian; larger avoids turning
    levels: int = 5  # halvings between two searches; larger searches less often and cuts more
    most_boxes: int = 400_000  # larger goes on longer, at 1 kB a box, before answering "undecided"
    shortcuts: int = 200  # straight motions tried to shorten a path; larger is shorter and slower
    smaller_robots: int = 7  # tried to say by how much the robot is too large; larger is more exact and slower


@dataclass(frozen=True, eq=False)
class BoxSpace:
    """A world prepared for one robot; the boxes of earlier queries serve later ones.

    outlines: the outer one, by which boxes are EMPTY, and the core, by which they are FULL; they differ by the chords
    around corners if clearance is asked for. course: the robot itself, for proofs of straight motions.
    """

    world: World
    robot: Robot
    settings: ConfigurationSpaceSettings
    outlines: tuple[Outline, Outline]
    walls: Walls
    course: Course
    tree: Tree
    front: Front
    queue: Queue


def prepare_boxes(world: World, robot: Robot, settings: ConfigurationSpaceSettings) -> BoxSpace:
    """What many queries share."""
    outer = robot.grown(float(outside_arcs(settings.clearance, CHORDS)))
    outlines = outline_of(outer), outline_of(robot.grown(settings.clearance))
    walls = Walls(world.edges.reshape(-1, 4).copy(), world.grid)
    left, bottom, right, top = world.bounds
    frame = np.array([[left, bottom, 0.0], [right, top, 2 * np.pi / robot.symmetry]])
    tree = plant(*outlines, walls, frame, (outer.reach, settings.resolution, settings.most_boxes))
    front = front_for(tree, robot.symmetry)
    queue = queue_for(len(front.cost))
    return BoxSpace(world, robot, settings, outlines, walls, course_of(world, robot), tree, front, queue)


def query_boxes(space: BoxSpace, start: Floats, goal: Floats) -> Answer:
    """A path between poses (3,) with headings in [0, 2π) or nan for any; or the proof that there is none."""
    room = space.robot.inner + space.settings.clearance
    if parted(space.world, room, start[:2], goal[:2]):
        reason = f"places with {room:.4g} m of room around them, as every heading needs, do not join start and goal"
        return Answer("no path", reason, cells=_cells(space.tree))
    answer = _searched(space, start, goal)
    if answer.kind != "undecided":
        return answer
    ends = [_moored(space, pose) for pose in (start, goal)]
    if all(tied is pose for tied, pose in zip(ends, (start, goal), strict=True)):
        return answer
    between = _searched(space, *ends)
    return between if between.path is None else _found(space, _tied(start, between.path.poses, goal))


def _moored(space: BoxSpace, pose: Floats) -> Floats:
    period = 2 * np.pi / space.robot.symmetry
    return moored(space.tree, space.course, pose, _kept(space), period)


def _tied(start: Floats, poses: Floats, goal: Floats) -> Floats:
    """The motion with its own start and goal before and after; headings stay unwrapped."""
    first, last = start.copy(), goal.copy()
    for end, beside in ((first, poses[0]), (last, poses[-1])):
        end[2] = beside[2] if np.isnan(end[2]) else end[2] + 2 * np.pi * np.round((beside[2] - end[2]) / (2 * np.pi))
    return np.concatenate([first[None], poses, last[None]])


def _kept(space: BoxSpace) -> float:
    """What straight motions keep from all walls."""
    return max(space.settings.clearance, space.world.grid)


def _searched(space: BoxSpace, start: Floats, goal: Floats) -> Answer:
    asked, settings = _asked(space, start, goal), space.settings
    forget(space.front)
    status, last, searches = refine(space.tree, space.outlines, space.walls, asked, space.front, space.queue)
    if status == FOUND:
        return _found(space, _poses(space, asked, last))
    if status == EXHAUSTED:
        return _undecided(space, f"all {settings.most_boxes} boxes are used up; a coarser resolution needs fewer")
    asked.factors[SMALL] = 1.0
    if search(space.tree, asked, space.front, space.queue, searches + 1, EVERYWHERE)[0] >= 0:
        return _undecided(space, f"only partly free boxes of {settings.resolution:g} m join start and goal")
    full = int((space.tree.labels[: space.tree.used[CELLS]] == FULL).sum())
    return Answer("no path", f"{full} boxes that collide throughout separate start and goal", cells=_cells(space.tree))


def _undecided(space: BoxSpace, why: str) -> Answer:
    return Answer("undecided", why, cells=_cells(space.tree))


def _found(space: BoxSpace, poses: Floats) -> Answer:
    """The path, shortened by straight motions that are proved to keep the clearance as well."""
    settings = space.settings
    shorter = shortened(space.course, poses, _kept(space), settings.turn_cost, settings.shortcuts)
    clearance = max(clearance_of(space.course, shorter, 1e-3 * space.robot.reach), settings.clearance)
    certificate = "every piece lies in a box free throughout, or is a straight motion proved by hull and sag"
    reason = f"a path of {len(shorter)} poses, proved free through {space.tree.used[CELLS]} boxes"
    return Answer("path", reason, Path(shorter, clearance, certificate), cells=_cells(space.tree))


def _asked(space: BoxSpace, start: Floats, goal: Floats) -> Query:
    factors = np.full(5, np.inf)
    factors[EMPTY], factors[MIXED] = 1.0, space.settings.mixed_cost
    sheets, levels, turn_cost = space.robot.symmetry, space.settings.levels, space.settings.turn_cost
    turned = np.array([start, goal])
    turned[:, 2] %= 2 * np.pi
    guide = guide_to(space.world, space.robot.inner + space.settings.clearance, goal)
    return Query(turned[0], turned[1], sheets, 2 * np.pi / sheets, factors, turn_cost, levels, guide)


def _poses(space: BoxSpace, asked: Query, last: int) -> Floats:
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
