"""Poses from sonar and infrared: drives through simulated floors, judged by the true poses beside the wheels alone.

All with the same settings; each drive's own seed makes its noise. The office is driven by sonar here, not by lidar.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from shapely.affinity import skew
from shapely.geometry import mapping, shape

from backend.estimate import Estimate
from frontend.rigid_motion import between, wrap
from frontend.scan import Floats, Scan
from slam.mapper import Mapper
from slam.readers.recording import OdometryNoise
from slam.recordings import open_recording
from slam.scores.trajectories import absolute_errors
from slam.settings import Settings, knowing
from slam.simulation.random_plans import random_plan
from slam.simulation.record import Recipe, drive_through
from slam.simulation.trajectory import in_first_frame, true_poses
from slam.simulation.world import World, build_world, read_plan
from slam.trajectory_file import read_trajectory

DATASETS = Path(__file__).parents[2] / "datasets"
FLOORS = (*range(11, 18), *range(31, 37))  # seeds of random floors of six rooms, and of their drives
UNSEEN = range(61, 71)  # the same, of floors that nobody looked at while the method was chosen
ASKEW = range(71, 75)  # the same, of floors whose walls do not stand square
OFFICE = range(1, 5)  # seeds of drives through the office: where wheels slip in its bare corridors differs
NEAR = 0.05  # metres: the target for a floor
Row = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Drive:
    """Scans, the true poses (n, 3) in the first one's frame, and what is known of the wheels."""

    name: str
    scans: Sequence[Scan]
    true: Floats
    wheels: OdometryNoise | None


@dataclass(frozen=True, eq=False)
class Judged:
    """A drive's error beside that of its wheels, in metres, NEES per degree of freedom, and CPU seconds a scan."""

    name: str
    error: float
    by_wheels: float
    nees: float
    seconds: float


def rows() -> list[Row]:
    """One row per figure; the first drive compiles."""
    moves = basement_rows()
    home, *others = (judged(drive) for drive in (apartment(), *map(floor, FLOORS)))
    unseen = [judged(floor(seed)) for seed in UNSEEN]
    plan = read_plan(DATASETS / "plans" / "office.geojson")
    office = [judged(driven("office", plan, seed)) for seed in OFFICE]
    single = [drive_row(home), drive_row(office[0]) | {"target": None}]
    groups = floor_rows("other floors", others) + floor_rows("floors never looked at", unseen)
    groups += floor_rows("floors 3° off the square", [judged(askew_floor(seed, 3.0)) for seed in ASKEW])
    groups += floor_rows("office, four drives", office)
    return [*moves, *single, *groups, nees_row([home, *others, *unseen, *office])]


def apartment() -> Drive:
    """The recorded drive through six furnished rooms."""
    recording, true = open_recording(DATASETS / "apartment"), read_trajectory(DATASETS / "apartment" / "true.tum")
    return Drive("apartment", recording.scans, true.poses, recording.odometry_noise)


def floor(seed: int) -> Drive:
    """A drive through a random floor of six rooms."""
    return driven(f"floor {seed}", build_world(random_plan(seed, 6)), seed)


def askew_floor(seed: int, degrees: float) -> Drive:
    """A drive through a random floor whose walls cross so much off the right angle."""
    plan = random_plan(seed, 6)
    for feature in plan["features"]:
        feature["geometry"] = mapping(skew(shape(feature["geometry"]), xs=degrees, origin=(0, 0)))
    return driven(f"askew floor {seed}", build_world(plan), seed)


def basement_rows() -> list[Row]:
    """The worst of the moves between the paper's three views."""
    folder = DATASETS / "flynn_basement"
    recording, true = open_recording(folder), read_trajectory(folder / "true.tum").poses
    estimate = mapped(recording.scans, knowing(Settings(), recording.odometry_noise))
    ours, theirs = (worst_move(p, true) for p in (estimate.poses, odometry_of(recording.scans)))
    note = "two moves of 2 ft; the worse one"
    return [
        row("basement: a move's way", ours[0], "m", 0.02, {"wheels alone": theirs[0]}, note),
        row("basement: a move's turn", ours[1], "°", 1.0, {"wheels alone": theirs[1]}, note),
    ]


def drive_row(drive: Judged) -> Row:
    """The absolute trajectory error of one drive."""
    note = f"{drive.seconds * 1000:.0f} ms CPU a scan, front end included"
    return row(f"{drive.name}: ATE", drive.error, "m", NEAR, {"wheels alone": drive.by_wheels}, note)


def floor_rows(name: str, floors: list[Judged]) -> list[Row]:
    """Median and worst of several drives."""
    ours, theirs = np.array([(floor.error, floor.by_wheels) for floor in floors]).T
    note = f"{len(floors)} drives: {', '.join(f'{value:.3f}' for value in ours)}"
    return [
        row(f"{name}: {which} ATE", float(of(ours)), "m", NEAR, {"wheels alone": float(of(theirs))}, note)
        for which, of in (("median", np.median), ("worst", np.max))
    ]


def nees_row(drives: list[Judged]) -> Row:
    """Whether the covariances tell how far off the poses are; those of one drive err together, so drives are many."""
    note = f"median of {len(drives)} drives, 1 is honest: {', '.join(f'{drive.nees:.1f}' for drive in drives)}"
    return row(
        "squared error over its covariance, a dof", float(np.median([d.nees for d in drives])), "", 1.0, {}, note
    )


def judged(drive: Drive, settings: Settings | None = None) -> Judged:
    """How a drive is mapped; settings: with what is known of its wheels, unless given."""
    clock = process_time()
    estimate = mapped(drive.scans, settings or knowing(Settings(), drive.wheels))
    seconds = (process_time() - clock) / len(drive.scans)
    by_wheels = rmse(odometry_of(drive.scans), drive.true)
    return Judged(drive.name, rmse(estimate.poses, drive.true), by_wheels, nees(estimate, drive.true), seconds)


def nees(estimate: Estimate, true: Floats) -> float:
    """Mean squared Mahalanobis distance of the poses but the first from the true ones (n, 3), per degree of freedom."""
    errors = np.array([between(*pair) for pair in zip(true[1:], estimate.poses[1:], strict=True)])
    return float(np.mean(np.einsum("ni,nij,nj->n", errors, np.linalg.inv(estimate.covariances[1:]), errors)) / 3)


def driven(name: str, world: World, seed: int) -> Drive:
    """A world's own drive; its seed makes all noise."""
    if world.drive is None:
        raise ValueError(f"{world.name} has no drive")
    stood, recipe = true_poses(world.drive), Recipe(seed=seed)
    noise = recipe.wheel_noise(world.drive)
    known = OdometryNoise(
        distance_noise=noise.distance, turn_noise=noise.turn, turn_per_metre_noise=noise.turn_per_metre
    )
    return Drive(name, drive_through(world, stood, recipe), in_first_frame(stood), known)


def mapped(scans: Iterable[Scan], settings: Settings) -> Estimate:
    """The estimate after all scans."""
    mapper = Mapper(settings.frontend, settings.poses)
    for scan in scans:
        mapper.add(scan)
    return mapper.result()


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


def row(name: str, value: float, unit: str, target: float | None, peers: dict[str, float], note: str) -> Row:
    """A figure where less is better."""
    return {
        "part": "poses", "name": name, "value": value, "unit": unit, "better": "lower",
        "target": target, "peers": peers, "runs": 1, "note": note,
    }  # fmt: skip
