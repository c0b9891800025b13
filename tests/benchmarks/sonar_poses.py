"""Poses from sonar and infrared: drives through simulated floors, judged by the true poses beside the wheels alone.

All with the same settings; each drive's own seed makes its noise. The office is driven by sonar here, not by lidar.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from frontend.rigid_motion import between, wrap
from frontend.scan import Floats, Scan
from slam.mapper import Mapper
from slam.readers.recording import OdometryNoise
from slam.recordings import open_recording
from slam.settings import Settings, knowing
from slam.simulation.random_plans import random_plan
from slam.simulation.record import Recipe, drive_through
from slam.simulation.trajectory import in_first_frame, true_poses
from slam.simulation.world import World, build_world, read_plan
from slam.trajectory_file import read_trajectory
from slam.trajectory_scores import absolute_errors

DATASETS = Path(__file__).parents[2] / "datasets"
FLOORS = range(11, 18)  # seeds of random floors of six rooms, and of their drives
NEAR = 0.05  # metres: the target for a floor
Row = dict[str, Any]


def rows() -> list[Row]:
    """One row per figure; the first drive compiles."""
    moves = basement_rows()
    recording = open_recording(DATASETS / "apartment")
    true = read_trajectory(DATASETS / "apartment" / "true.tum").poses
    apartment = drive_row("apartment", recording.scans, true, recording.odometry_noise)
    floors = [drive_row(f"floor {seed}", *driven(build_world(random_plan(seed, 6)), seed)) for seed in FLOORS]
    office = drive_row("office", *driven(read_plan(DATASETS / "plans" / "office.geojson"), 1))
    return [*moves, apartment, *floor_rows(floors), office | {"target": None}]


def basement_rows() -> list[Row]:
    """The worst of the moves between the paper's three views."""
    folder = DATASETS / "flynn_basement"
    recording, true = open_recording(folder), read_trajectory(folder / "true.tum").poses
    poses, _ = mapped(recording.scans, recording.odometry_noise)
    ours, theirs = (worst_move(p, true) for p in (poses, odometry_of(recording.scans)))
    note = "two moves of 2 ft; the worse one"
    return [
        row("basement: a move's way", ours[0], "m", 0.02, {"wheels alone": theirs[0]}, note),
        row("basement: a move's turn", ours[1], "°", 1.0, {"wheels alone": theirs[1]}, note),
    ]


def drive_row(name: str, scans: Sequence[Scan], true: Floats, wheels: OdometryNoise | None) -> Row:
    """The absolute trajectory error of one drive."""
    poses, seconds = mapped(scans, wheels)
    note = f"{len(scans)} scans, {seconds / len(scans) * 1000:.0f} ms CPU a scan, front end included"
    return row(f"{name}: ATE", rmse(poses, true), "m", NEAR, {"wheels alone": rmse(odometry_of(scans), true)}, note)


def floor_rows(floors: list[Row]) -> list[Row]:
    """Median and worst of several drives."""
    ours = np.array([floor["value"] for floor in floors])
    theirs = np.array([floor["peers"]["wheels alone"] for floor in floors])
    note = f"{len(floors)} random floors of six rooms: {', '.join(f'{value:.3f}' for value in ours)}"
    return [
        row("other floors: median ATE", float(np.median(ours)), "m", NEAR, {"wheels alone": np.median(theirs)}, note),
        row("other floors: worst ATE", float(np.max(ours)), "m", NEAR, {"wheels alone": np.max(theirs)}, note),
    ]


def driven(world: World, seed: int) -> tuple[list[Scan], Floats, OdometryNoise]:
    """The scans of a world's own drive, its true poses (n, 3) in the first one's frame, and what its wheels are."""
    if world.drive is None:
        raise ValueError(f"{world.name} has no drive")
    stood, recipe = true_poses(world.drive), Recipe(seed=seed)
    noise = recipe.wheel_noise(world.drive)
    known = OdometryNoise(
        distance_noise=noise.distance, turn_noise=noise.turn, turn_per_metre_noise=noise.turn_per_metre
    )
    return drive_through(world, stood, recipe), in_first_frame(stood), known


def mapped(scans: Sequence[Scan], wheels: OdometryNoise | None) -> tuple[Floats, float]:
    """Poses (n, 3) after all scans, and the CPU seconds they took."""
    settings, clock = knowing(Settings(), wheels), process_time()
    mapper = Mapper(settings.frontend, settings.poses)
    for scan in scans:
        mapper.add(scan)
    return mapper.result().poses, process_time() - clock


def worst_move(poses: Floats, true: Floats) -> tuple[float, float]:
    """The largest error of a move between successive poses (n, 3): metres and degrees."""
    errors = np.array([between(*a) - between(*b) for a, b in zip(pairwise(poses), pairwise(true), strict=True)])
    return float(np.hypot(*errors[:, :2].T).max()), float(np.degrees(np.abs(wrap(errors[:, 2]))).max())


def rmse(poses: Floats, true: Floats) -> float:
    """Root mean square distance after the best rigid alignment."""
    return float(np.sqrt(np.mean(absolute_errors(poses[:, :2], true[:, :2]) ** 2)))


def odometry_of(scans: Sequence[Scan]) -> Floats:
    """Raw odometry (n, 3) of the scans."""
    return np.array([scan.odometry for scan in scans])


def row(name: str, value: float, unit: str, target: float, peers: dict[str, float], note: str) -> Row:
    """A figure where less is better."""
    return {
        "part": "poses", "name": name, "value": value, "unit": unit, "better": "lower",
        "target": target, "peers": peers, "runs": 1, "note": note,
    }  # fmt: skip
