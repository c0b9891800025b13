"""The plans on which merges are compared: furnished ones at random, and real floors; each with lidar views.

The views are what the front end makes of a lidar's turn, as in every run of the pipeline. A beam without echo is free
as far as the lidar reaches, as these lidars lose no echo.
"""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from backend.view import View
from frontend.fusion import FusionSettings
from frontend.scan import Scan, Sensor
from slam.perception import FrontendSettings, perceive
from slam.scores.maps import MapTruth
from slam.simulation.floors import polygons_of
from slam.simulation.mlstruct import convert_mlstruct
from slam.simulation.world import build_world
from tests.backend.plan_rays import Plan, Rays, cast, furnished_plan, scattered_poses, seen_from, segments_of

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
    views = [_perceived(plan, pose, rng) for pose in poses]
    seen = seen_from(plan, poses, Rays().max_range)
    return Case(plan, MapTruth(plan.free, seen, plan.doors, plan.obstacles), poses, views)


def _perceived(plan: Plan, pose: Floats, rng: np.random.Generator) -> View:
    """The front end's view of one turn of a lidar at the true pose (3,)."""
    rays = Rays()
    bearings = np.linspace(-np.pi, np.pi, rays.beams, endpoint=False)
    true = cast(segments_of(plan.free), pose, bearings)
    ranges = np.where(true < rays.max_range, true + rng.normal(0, rays.noise, rays.beams), np.inf)
    scan = Scan(bearings, ranges, Sensor("lidar", rays.max_range, range_noise=rays.noise), np.zeros(3), 0.0)
    return perceive(scan, FrontendSettings(fusion=FusionSettings(no_return_clears=rays.max_range))).view
