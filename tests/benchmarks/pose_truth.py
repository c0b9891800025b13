"""Poses against exact truth: lidar drives through random furnished floors.

Relations checked by hand are themselves 1 to 2 cm wrong; what lies below that only a simulation can tell.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from backend.joint_refinement import RefinementSettings
from frontend.rigid_motion import compose
from frontend.scan import Floats, Scan, Sensor
from frontend.sensors.lidar import LIDAR, lidar_ranges
from slam.scores.trajectories import absolute_errors
from slam.settings import Settings
from slam.simulation.random_plans import FloorRules, random_plan
from slam.simulation.record import SENSORS
from slam.simulation.trajectory import WheelNoise, true_poses, wheel_odometry
from slam.simulation.world import build_world
from tests.benchmarks.poses import mapped, odometry_of

HALF_TURN = Sensor(kind="lidar", min_range=0.05, max_range=30.0, range_noise=0.01, quantum=0.01)
SCANNERS = (
    ("180 beams ahead, 1 cm noise", HALF_TURN, np.radians(np.arange(-90.0, 90.0)), 0.15),
    ("360 beams around, 1.5 cm noise", LIDAR, np.array(SENSORS["lidar"].bearings), 0.3),
)
SEEDS = (1, 2, 3)
ROOMS = 10
SECONDS = 0.3  # between two scans
WHEELS = WheelNoise(distance=0.05, turn=0.05, turn_per_metre=0.02)

Row = dict[str, Any]


def rows() -> list[Row]:
    """The mean error of position of each scanner, over floors that it drives through once."""
    return [
        _row(name, [_errors(seed, sensor, bearings, step) for seed in SEEDS])
        for name, sensor, bearings, step in SCANNERS
    ]


def drive(seed: int, sensor: Sensor, bearings: Floats, step: float) -> tuple[list[Scan], Floats]:
    """Scans `step` metres apart through a random floor, and the true poses (n, 3)."""
    world = build_world(random_plan(seed, ROOMS, FloorRules(step=step)))
    assert world.drive is not None
    poses, rng = true_poses(world.drive), np.random.default_rng(seed)
    wheels, mount = wheel_odometry(poses, WHEELS, rng), np.array(sensor.mount)
    scans = [
        Scan(
            bearings,
            lidar_ranges(world.surfaces, compose(pose, mount), bearings, sensor, rng),
            sensor,
            claimed,
            SECONDS * k,
        )
        for k, (pose, claimed) in enumerate(zip(poses, wheels, strict=True))
    ]
    return scans, poses


def _errors(seed: int, sensor: Sensor, bearings: Floats, step: float) -> dict[str, float]:
    """Mean distance in millimetres from the true places, of the whole method, without its last step, and of wheels."""
    scans, true = drive(seed, sensor, bearings, step)
    usual = Settings().poses
    answers = {
        "ours": mapped(scans)[1].poses,
        "without joint refinement": mapped(scans, replace(usual, refinement=RefinementSettings(cells=())))[1].poses,
        "wheels alone": odometry_of(scans),
    }
    return {who: 1e3 * float(np.mean(absolute_errors(poses[:, :2], true[:, :2]))) for who, poses in answers.items()}


def _row(name: str, errors: list[dict[str, float]]) -> Row:
    means = {who: float(np.mean([error[who] for error in errors])) for who in errors[0]}
    spread = ", ".join(f"{error['ours']:.2f}" for error in errors)
    return {
        "part": "pose_truth", "name": f"{name}: mean error of position", "value": means.pop("ours"), "unit": "mm",
        "better": "lower", "target": None, "peers": means, "runs": len(errors),
        "note": f"random furnished floors of {ROOMS} rooms, after rigid alignment; floor by floor {spread}",
    }  # fmt: skip
