"""An oracle without cleverness: a fine grid of x, y and heading, exact distances at its nodes, and connected parts.

While a robot moves or turns from a node to the next, none of its points travels farther than one step. If it keeps more
than half a step from all walls at both nodes, the motion between them is free: nodes of one part are surely joined.
"""

from collections import Counter
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.ndimage import generate_binary_structure, label
from shapely import STRtree, box

from planners.configuration_space import ConfigurationSpaceSettings, plan
from planners.robot import Robot
from planners.world import World
from tests.planners.random_worlds import SIDE, random_obstacles, random_robot

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Flooded:
    """poses (n, 3) of the nodes that keep half a step away, and the part (n,) of each."""

    poses: Floats
    parts: NDArray[np.int64]


def flooded(world: World, robot: Robot, step: float) -> Flooded:
    """All surely free nodes of a grid with `step` metres between them, and what joins them."""
    left, bottom, right, top = world.bounds
    turns = max(4, int(np.ceil(2 * np.pi * robot.reach / step)))
    axes = np.arange(left, right, step), np.arange(bottom, top, step), np.arange(turns) * 2 * np.pi / turns
    poses = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    free = _keeps(world, robot, poses.reshape(-1, 3), step / 2).reshape(poses.shape[:3])
    numbers = np.asarray(label(free, structure=generate_binary_structure(3, 1))[0], dtype=np.int64)
    return Flooded(poses[free], _round(numbers)[numbers[free]])


def _keeps(world: World, robot: Robot, poses: Floats, distance: float) -> NDArray[np.bool_]:
    """Which poses (n, 3) keep more than `distance` from all walls."""
    free = shapely.contains_xy(world.free, poses[:, 0], poses[:, 1])
    tree, asked = STRtree(np.asarray(shapely.linestrings(world.edges))), np.flatnonzero(free)
    cosine, sine = np.cos(poses[asked, 2:]), np.sin(poses[asked, 2:])
    for part in robot.parts:
        x = poses[asked, :1] + cosine * part[:, 0] - sine * part[:, 1]
        y = poses[asked, 1:2] + sine * part[:, 0] + cosine * part[:, 1]
        corners = np.stack([x, y], axis=2)
        shapes = shapely.polygons(corners) if len(part) > 2 else shapely.points(corners[:, 0])
        free[asked[np.unique(tree.query(shapes, "dwithin", distance + robot.radius)[0])]] = False
        free[asked] &= shapely.contains_xy(world.free, corners[:, 0, 0], corners[:, 0, 1])
    return free


def _round(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    """New names of the parts, the same for those that meet across the end of the circle of headings."""
    names = np.arange(int(numbers.max()) + 1)
    for one, two in np.unique(np.stack([numbers[..., 0].ravel(), numbers[..., -1].ravel()], axis=1), axis=0):
        if one and two:
            names[names == names[one]] = names[two]
    return names


def refutations(rng: np.random.Generator, queries: int, step: float) -> Counter[str]:
    """The planner's answers in a small crowded world, and how many proofs of "no path" the flood refutes."""
    low, high = 0.38 * SIDE, 0.62 * SIDE
    world = World.from_obstacles(box(low, low, high, high), random_obstacles(rng))
    robot, counts = random_robot(rng).scaled(1.3), Counter[str]()
    nodes = flooded(world, robot, step)
    settings = ConfigurationSpaceSettings(resolution=0.25, most_boxes=60_000, smaller_robots=0, shortcuts=0)
    for start, goal in rng.integers(max(len(nodes.poses), 1), size=(queries if len(nodes.poses) else 0, 2)):
        kind = plan(world, robot, nodes.poses[start], nodes.poses[goal], settings).kind
        counts[kind] += 1
        counts["refuted"] += kind == "no path" and bool(nodes.parts[start] == nodes.parts[goal])
    return counts
