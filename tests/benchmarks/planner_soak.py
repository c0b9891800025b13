"""Random queries in random worlds: what both planners answer, checked by proofs that share no code with them."""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon, box

from planners import configuration_space, generalized_cones
from planners.certify import certify
from planners.configuration_space import ConfigurationSpaceSettings
from planners.explain import narrowest
from planners.generalized_cones import ConesSettings
from planners.path import Answer
from planners.robot import Robot
from planners.world import World
from tests.planners.random_worlds import random_pose, random_robot, random_world

Floats = NDArray[np.float64]

CONES = ConesSettings(shortcuts=20)
BOXES = ConfigurationSpaceSettings(resolution=0.5, most_boxes=60_000, smaller_robots=0, shortcuts=60)


@dataclass(frozen=True, eq=False)
class Soak:
    """Counts over all queries; refuted: answers "no path" where a path is known; invalid: paths not certified."""

    kinds: Counter[str] = field(default_factory=Counter)
    invalid: Counter[str] = field(default_factory=Counter)
    raised: Counter[str] = field(default_factory=Counter)
    refuted: Counter[str] = field(default_factory=Counter)
    queries: Counter[str] = field(default_factory=Counter)


def soak(worlds: int, each: int, first: int = 0) -> Soak:
    """`each` queries in every one of `worlds` random worlds, seeded from `first` on."""
    counts = Soak()
    for seed in range(first, first + worlds):
        rng = np.random.default_rng(seed)
        world = random_world(rng)
        for _ in range(each):
            robot = random_robot(rng)
            start, goal = random_pose(rng, world, robot), random_pose(rng, world, robot)
            if start is not None and goal is not None:
                _ask(counts, world, robot, (start, goal))
    return counts


def _ask(counts: Soak, world: World, robot: Robot, ends: tuple[Floats, Floats]) -> None:
    answers: dict[str, Answer] = {}
    counts.queries["all"] += 1
    for name in ("cones", "boxes"):
        try:
            answers[name] = _answer(name, world, robot, ends)
        except Exception:  # noqa: BLE001 - what is counted here is exactly that anything was raised
            counts.raised[name] += 1
            continue
        answer = answers[name]
        counts.kinds[f"{name}: {answer.kind}"] += 1
        if answer.path is not None and not certify(answer.path.poses, robot, world.free):
            counts.invalid[name] += 1
    if "boxes" in answers and answers["boxes"].kind == "no path":
        known = "cones" in answers and answers["cones"].path is not None
        wide = narrowest(world, ends[0][:2], ends[1][:2])[0] > 2.01 * robot.reach
        counts.refuted["boxes"] += known or wide


def _answer(name: str, world: World, robot: Robot, ends: tuple[Floats, Floats]) -> Answer:
    if name == "cones":
        return generalized_cones.query(generalized_cones.prepare(world, robot, CONES), *ends)
    return configuration_space.plan(world, robot, *ends, BOXES)


def corridors(count: int, resolution: float) -> int:
    """How many of `count` random corridors are passed whose clearance is 2.42 resolutions.

    A corridor of any direction joins two halls in which a 3 x 1 rectangle can turn.
    """
    rng, robot, passed = np.random.default_rng(0), Robot.rectangle(3, 1), 0
    settings = ConfigurationSpaceSettings(resolution=resolution, shortcuts=0, smaller_robots=0)
    half = 0.5 + 2.43 * resolution
    for _ in range(count):
        angle = rng.uniform(0, 2 * np.pi)
        along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        places = [(-12, half), (12, half), (12, 60.0), (-12, 60.0)]
        blocks = [Polygon([u * along + sign * v * across for u, v in places]) for sign in (1, -1)]
        world = World.from_obstacles(box(-20, -20, 20, 20), blocks)
        start, goal = (np.append(side * 16 * along, rng.uniform(0, 2 * np.pi)) for side in (-1, 1))
        passed += configuration_space.plan(world, robot, start, goal, settings).kind == "path"
    return passed
