"""Paths along the spines of generalized cones (Brooks 1983; Flynn 1988, §4.3): fast, in the middle of free space.

The robot translates along spines and turns where they cross. The planner is a heuristic: it finds a path or it does
not, and never says that there is none.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from planners.chains import Chain, entered, motion_of, straight, threaded
from planners.cone_outlines import cone_outlines
from planners.entrances import COST, NODE, entrances
from planners.freeways import faces_of, facing_pairs, spines
from planners.lost_headings import why_not
from planners.motion import Course, clearance_of, course_of
from planners.path import Answer, Cone, Path
from planners.poses import Pose, standing
from planners.robot import Robot
from planners.shortcut import shortened
from planners.slices import Body, Slices, slices_of
from planners.spine_graph import SpineGraph, graph_of
from planners.spine_search import Route, landmarks_of, route
from planners.world import World

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ConesSettings:
    """Opinions of the generalized-cones planner."""

    slice_length: float = 0.5  # in widths of the robot; larger is faster to prepare and loses orientations
    detail: float = (
        0.05  # in widths of the robot: corners that walls are smoothed by; larger is faster, misses tight ways
    )
    crowding: float = 0.2  # a cone needs a place where no wall is nearer than this share of its own; larger: fewer
    caution: float = 1.0  # extra cost per metre in the tightest passages; larger goes farther to stay clear of walls
    entrances: int = 16  # spines tried from start and goal; larger finds more and asks more time of every query
    shortcuts: int = 0  # straight motions tried to shorten a path; larger is shorter, and leaves the middle
    turn_cost: float = 0.1  # metres per radian while shortening; larger avoids turning


@dataclass(frozen=True, eq=False)
class Cones:
    """A world prepared for one robot. lines (f, 3) of the faces that make the spines; runs (k, 8): the spines, rows of
    `freeways.spines`; landmarks (n, l): see `spine_search`."""

    world: World
    robot: Robot
    settings: ConesSettings
    body: Body
    lines: Floats
    runs: Floats
    slices: Slices
    graph: SpineGraph
    landmarks: Floats
    course: Course


def plan(world: World, robot: Robot, start: Pose, goal: Pose, settings: ConesSettings) -> Answer:
    """A path of `robot` in `world` from `start` to `goal` (3,) along the spines of cones, or why none was found."""
    cones = _without_landmarks(world, robot, settings)
    return replace(query(cones, start, goal), cones=drawn(cones))


def prepare(world: World, robot: Robot, settings: ConesSettings) -> Cones:
    """All cones with their legal orientations and crossings: what many queries share."""
    cones = _without_landmarks(world, robot, settings)
    return replace(cones, landmarks=landmarks_of(cones.graph))


def _without_landmarks(world: World, robot: Robot, settings: ConesSettings) -> Cones:
    """Cones for a single query: landmarks cost as much as many searches."""
    body = _body(world, robot, settings)
    faces, lines = faces_of(world, settings.detail * robot.width)
    runs = spines(facing_pairs(faces, lines), faces, lines, body.ends, robot.width, settings.crowding)
    runs = _distinct(runs, world.grid)
    slices, kept = slices_of(runs, body)
    graph = graph_of(slices, settings.caution)
    none, course = np.zeros((len(graph.arcs), 0)), course_of(world, robot)
    return Cones(world, robot, settings, body, lines, runs[kept], slices, graph, none, course)


def drawn(cones: Cones) -> tuple[Cone, ...]:
    """The cones with their outlines, for figures."""
    return cone_outlines(cones.slices, cones.body.ends, cones.lines, cones.runs[:, 4:6])


def query(cones: Cones, start: Pose, goal: Pose) -> Answer:
    """A path from `start` to `goal` (3,) with a heading, nan or None for any; or why none was found.

    Raises PlanningError where the robot cannot stand.
    """
    begin = standing(cones.world, cones.robot, start, "start")
    end = standing(cones.world, cones.robot, goal, "goal")
    through = _through(cones, begin, end)
    chains = [chain for chain in (straight(cones.body, begin, end), through) if isinstance(chain, Chain)]
    if not chains:
        return Answer("not found", f"no way along {len(cones.runs)} cones: {through}")
    return _found(cones, motion_of(min(chains, key=lambda chain: chain.cost)))


def _found(cones: Cones, poses: Floats) -> Answer:
    """The path, shortened if the settings say so."""
    settings, grid = cones.settings, cones.world.grid
    if settings.shortcuts:
        poses = shortened(cones.course, poses, grid, settings.turn_cost, settings.shortcuts)
    clearance = max(clearance_of(cones.course, poses, 1e-3 * cones.robot.reach), 0.0)
    certificate = "on every piece the heading is legal, or the straight motion is proved by hull and sag"
    reason = f"a path of {len(poses)} poses along {len(cones.runs)} cones"
    return Answer("path", reason, Path(poses, clearance, certificate))


def _body(world: World, robot: Robot, settings: ConesSettings) -> Body:
    corners = robot.corners
    polar = np.column_stack([np.hypot(corners[:, 0], corners[:, 1]), np.arctan2(corners[:, 1], corners[:, 0])])
    ends = world.edges.reshape(-1, 4).copy()
    reach, step = robot.reach + world.grid, settings.slice_length * robot.width
    return Body(polar, robot.radius, ends, world.grid, reach, robot.width, step, settings.caution)


def _distinct(runs: Floats, grid: float) -> Floats:
    """Runs without repetitions: walls of one line give the same spine over and over."""
    _, first = np.unique(np.round(runs[:, :4] / (64 * grid)), axis=0, return_index=True)
    return np.ascontiguousarray(runs[np.sort(first)])


def _through(cones: Cones, begin: Floats, end: Floats) -> Chain | str:
    """The best way through the graph of spines, or why there is none."""
    into, out = _entries(cones, begin), _entries(cones, end)
    for rows, name in ((into, "start"), (out, "goal")):
        if not len(rows):
            return f"by no spine can a crossing be reached from the {name} at a heading that is legal on the way"
    entry, leave = (np.full(len(cones.graph.arcs), np.inf) for _ in range(2))
    for metres, rows in ((entry, into), (leave, out)):
        np.minimum.at(metres, rows[:, NODE].astype(int), rows[:, COST])
    found = route(cones.graph, cones.landmarks, entry, leave)
    if not isinstance(found, Route):
        return why_not(cones.slices, cones.graph, found, end)
    first, last = _cheapest(into, int(found.nodes[0])), _cheapest(out, int(found.nodes[-1]))
    return threaded(cones.graph, entered(cones.graph, first, begin), found, entered(cones.graph, last, end).reversed())


def _entries(cones: Cones, pose: Floats) -> Floats:
    return entrances(cones.body, cones.slices, cones.graph, pose, cones.settings.entrances)


def _cheapest(rows: Floats, node: int) -> Floats:
    """The row of the cheapest way to a node."""
    there = rows[rows[:, NODE] == node]
    return np.asarray(there[np.argmin(there[:, COST])])
