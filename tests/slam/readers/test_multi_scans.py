"""Multi-scans: what four beams saw along a piece of the way lies where the walls are."""

import numpy as np
from shapely import Point

from frontend.rigid_motion import transform
from frontend.scan import Floats, Scan, Sensor
from frontend.sensors.lidar import lidar_ranges
from slam.readers.multi_scans import PIECE, STEP, gathered
from slam.simulation.trajectory import in_first_frame
from tests.simulated_drives import once_round, round_building

FOUR = Sensor("time_of_flight", max_range=2.0, half_beam=0.2, range_noise=0.0)
BEAMS = np.radians([-90.0, 0.0, 90.0, 180.0])


def flown(poses: Floats) -> list[Scan]:
    """Four exact beams from true poses (p, 3), whose odometry is exact in the frame of the first."""
    world, rng = round_building(), np.random.default_rng(0)
    own = in_first_frame(poses)
    ranges = [lidar_ranges(world.surfaces, pose, BEAMS, FOUR, rng) for pose in poses]
    return [
        Scan(BEAMS, seen, FOUR, odometry, 0.1 * k) for k, (seen, odometry) in enumerate(zip(ranges, own, strict=True))
    ]


def test_the_ends_of_a_multi_scan_lie_on_the_walls() -> None:
    poses = once_round(step=0.06)
    found = gathered(flown(poses))
    free = round_building().free
    for scan in found[::5]:
        seen = np.isfinite(scan.ranges)
        rays = scan.ranges[seen, None] * np.column_stack([np.cos(scan.bearings[seen]), np.sin(scan.bearings[seen])])
        ends = transform(transform(rays, scan.odometry), poses[0])
        # A sector is 3 degrees wide: a wall that is seen along itself may lie that far aside.
        slack = 0.02 + 0.03 * scan.ranges[seen]
        apart = [free.boundary.distance(Point(end)) for end in ends]
        assert np.mean(np.array(apart) < slack) > 0.95
        assert seen.sum() > 30


def test_there_is_one_for_every_step_and_a_robot_that_stands_makes_one() -> None:
    poses = np.column_stack([np.arange(0, 6, 0.05) + 2, np.full(120, 1.2), np.zeros(120)])
    assert len(gathered(flown(poses))) == round(6 / STEP)
    assert len(gathered(flown(np.repeat(poses[:1], 30, axis=0)))) == 1


def test_where_no_beam_pointed_nothing_is_said_to_be_free() -> None:
    (scan,) = gathered(flown(np.array([[6.0, 1.2, 0.0]])))
    assert np.isfinite(scan.ranges).sum() <= 4
    assert not np.isinf(scan.ranges).any()
    assert scan.sensor.max_range == FOUR.max_range + PIECE / 2
