"""The plans on which merges are compared: furnished ones at random, and real floors; each with lidar views."""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from backend.view import View
from slam.map_scores import MapTruth
from slam.simulation.floors import polygons_of
from slam.simulation.mlstruct import convert_mlstruct
from slam.simulation.world import build_world
from tests.backend.plan_rays import Plan, Rays, furnished_plan, scattered_poses, seen_from, view_of

Floats = NDArray[np.float64]
VIEWS = 40
FLOORS = (302, 748, 848, 966, 1058, 1059, 1060)


@dataclass(frozen=True, eq=False)
class Case:
    """A plan, what its true poses saw, and the views."""

    plan: Plan
    truth: MapTruth
    poses: Floats
    views: list[View]


def furnished_case(number: int) -> Case:
    """A random plan of three rooms or more, with furniture."""
    rng = np.random.default_rng(1000 + number)
    return _case(furnished_plan(rng, 3 + number % 10), rng)


def floor_case(floor: int) -> Case:
    """A floor of the MLSTRUCT-FP set: the largest connected part of its free space."""
    drawings = Path(os.environ["ROOMSKETCH_DATA"]) / "floor_plans" / "mlstruct" / "fp.json"
    world = build_world(convert_mlstruct(drawings, floor))
    free: Polygon = max(polygons_of(world.free), key=lambda part: part.area)
    return _case(Plan(free, np.empty((0, 2, 2)), ()), np.random.default_rng(floor))


def _case(plan: Plan, rng: np.random.Generator) -> Case:
    poses = scattered_poses(plan, VIEWS, rng)
    views = [view_of(plan, pose, Rays(), rng) for pose in poses]
    seen = seen_from(plan, poses, Rays().max_range)
    return Case(plan, MapTruth(plan.free, seen, plan.doors, plan.obstacles), poses, views)
