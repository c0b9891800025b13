"""A sonar's drive through a simulated room: placed by arcs, far better than by its wheels."""

import numpy as np

from frontend.scan import Floats
from slam.mapper import Mapper
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings
from slam.simulation.random_plans import random_plan
from slam.simulation.record import Recipe, drive_through
from slam.simulation.trajectory import in_first_frame, true_poses
from slam.simulation.world import build_world
from slam.trajectory_scores import absolute_errors


def rmse(estimated: Floats, true: Floats) -> float:
    return float(np.sqrt(np.mean(absolute_errors(estimated[:, :2], true[:, :2]) ** 2)))


def test_arcs_place_a_sonar_better_than_its_wheels_do() -> None:
    world = build_world(random_plan(14, 6))
    assert world.drive is not None
    stood = true_poses(world.drive)[:25]
    scans = drive_through(world, stood, Recipe(seed=14))
    mapper = Mapper(FrontendSettings(), MapperSettings())
    for scan in scans:
        mapper.add(scan)
    estimate, true = mapper.result(), in_first_frame(stood)
    assert estimate.mapped.all()
    assert rmse(estimate.poses, true) < 0.1
    assert rmse(estimate.poses, true) < 0.5 * rmse(np.array([scan.odometry for scan in scans]), true)
    assert len(estimate.sightings) == len(estimate.landmarks) > 0
