"""Long rounds: 600 m of corridor round a block, by a cheap lidar and poor wheels, until the start comes into view.

What the drive drifts is more than any window covers: what closes it are constellations of corners. Every building, its
niches and all noise are drawn from a seed; none of these was looked at while the method was chosen.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import process_time

import numpy as np
from shapely import LineString, Polygon, box

from backend.estimate import Estimate
from frontend.rigid_motion import between
from frontend.scan import Floats, Scan
from frontend.sensors.lidar import LIDAR, lidar_ranges
from slam.mapper_settings import MapperSettings
from slam.scores.trajectories import Spread, absolute_errors
from slam.simulation.trajectory import WheelNoise, in_first_frame, wheel_odometry
from slam.simulation.world import World
from tests.benchmarks.pose_pieces import ABLATIONS, POSES
from tests.benchmarks.poses import Row, mapped, odometry_of
from tests.benchmarks.poses import row as figure
from tests.simulated_drives import world_of

SEEDS = range(20, 25)
LENGTH, DEPTH, WIDTH = 180.0, 120.0, 2.2  # metres of the block's outer walls, and of the corridor
CHEAP = replace(LIDAR, max_range=8.0, range_noise=0.02)
BEARINGS = np.radians(np.arange(-90.0, 91.0))
WHEELS = WheelNoise(distance=0.15, turn=0.05, turn_per_metre=0.1)
STEP, BEYOND = 0.4, 40.0  # metres between two scans, and driven after the round is closed
FALSE = 1.5  # metres by which a loop that was believed is false: a scan in a plain corridor may slide by one


@dataclass(frozen=True, eq=False)
class Round:
    """A drive with its true poses (n, 3), in the frame of the first."""

    scans: Sequence[Scan]
    true: Floats


def rows() -> list[Row]:
    """One row per figure."""
    rounds = [driven(seed) for seed in SEEDS]
    by_wheels = Spread.of(np.array([error(odometry_of(one.scans), one.true) for one in rounds])).median
    found = rows_of("", rounds, POSES, {"wheels alone": by_wheels})
    for name, settings in ABLATIONS:
        if name in {"constellations", "knots as landmarks", "loops"}:
            found += rows_of(f", without {name}", rounds, settings, {})
    return found


def rows_of(name: str, rounds: Sequence[Round], settings: MapperSettings, peers: dict[str, float]) -> list[Row]:
    """Error, rounds closed and false loops of all rounds with these settings."""
    clock = process_time()
    estimates = [mapped(one.scans, settings)[1] for one in rounds]
    seconds = (process_time() - clock) / len(rounds)
    errors = np.array([error(estimate.poses, one.true) for estimate, one in zip(estimates, rounds, strict=True)])
    closed = sum(any(made.what == "loop" and made.accepted for made in estimate.decisions) for estimate in estimates)
    false = sum(falsely(estimate, one.true) for estimate, one in zip(estimates, rounds, strict=True))
    note = f"{len(rounds)} drives of {len(rounds[0].scans)} scans, {seconds:.0f} s CPU each: "
    note += ", ".join(f"{value:.2f}" for value in errors)
    return [
        row(f"rounds of 600 m{name}: median ATE", float(np.median(errors)), "m", peers, note),
        row(f"rounds of 600 m{name}: closed", closed, "", {}, f"of {len(rounds)}") | {"better": "higher"},
        row(f"rounds of 600 m{name}: false loops believed", false, "", {}, "") | {"target": 0},
    ]


def driven(seed: int) -> Round:
    """A drive round a building of its own."""
    rng = np.random.default_rng(seed)
    world, true = building(rng), way()
    odometry = wheel_odometry(true, WHEELS, rng)
    scans = [
        Scan(BEARINGS, lidar_ranges(world.surfaces, pose, BEARINGS, CHEAP, rng), CHEAP, believed, 0.5 * number)
        for number, (pose, believed) in enumerate(zip(true, odometry, strict=True))
    ]
    return Round(scans, in_first_frame(true))


def building(rng: np.random.Generator) -> World:
    """A corridor round a block, with pilasters and cupboards on both of its walls."""
    solids = [box(WIDTH, WIDTH, LENGTH - WIDTH, DEPTH - WIDTH)]
    for side, length in enumerate((LENGTH, DEPTH, LENGTH, DEPTH)):
        along = WIDTH + 1 + rng.uniform(2.5, 9)
        while (end := along + rng.uniform(0.3, 2)) < length - WIDTH - 1:
            solids.append(thing(side, (along, end), rng))
            along = end + rng.uniform(2.5, 9)
    return world_of(box(0, 0, LENGTH, DEPTH), *solids)


def thing(side: int, along: tuple[float, float], rng: np.random.Generator) -> Polygon:
    """Something that stands before the outer or the inner wall of one side of the corridor."""
    depth = rng.uniform(0.15, 0.45)
    near, far = (WIDTH - depth, WIDTH) if rng.random() < 0.5 else (0.0, depth)
    if side >= 2:
        near, far = (DEPTH if side == 2 else LENGTH) - np.array([far, near])
    return box(along[0], near, along[1], far) if side in {0, 2} else box(near, along[0], far, along[1])


def way() -> Floats:
    """True poses (p, 3) along the middle of the corridor, once round and some metres on."""
    middle = box(WIDTH / 2, WIDTH / 2, LENGTH - WIDTH / 2, DEPTH - WIDTH / 2).buffer(-0.6).buffer(0.6)
    lane = LineString(np.array(middle.exterior.normalize().coords)[::-1])
    along = np.arange(0.0, lane.length + BEYOND, STEP)
    here, ahead = (
        np.array([lane.interpolate(at % lane.length).coords[0] for at in along + shift]) for shift in (0.0, 0.01)
    )
    return np.column_stack([here, np.arctan2(*(ahead - here).T[::-1])])


def error(poses: Floats, true: Floats) -> float:
    """Absolute trajectory error in metres."""
    return Spread.of(absolute_errors(poses[:, :2], true[:, :2])).rmse


def falsely(estimate: Estimate, true: Floats) -> int:
    """How many of the believed loops tie places that are not where they are said to be."""
    count = 0
    for tie in estimate.ties:
        first, last = estimate.keyframes[[tie.fixed, tie.moving]]
        off = between(tie.pose, between(true[first], true[last]))
        count += tie.moving > tie.fixed + 1 and float(np.hypot(*off[:2])) > FALSE
    return count


def row(name: str, value: float, unit: str, peers: dict[str, float], note: str) -> Row:
    """A figure of this part; nothing else was driven there, so the peers are only told."""
    return figure(name, value, unit, peers, note) | {"part": "long_rounds", "target": None}
