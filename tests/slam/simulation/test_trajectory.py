from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from frontend.rigid_motion import between
from slam.simulation.trajectory import WheelNoise, in_first_frame, true_poses, wheel_odometry
from slam.simulation.world import Drive

PERFECT = WheelNoise(distance=0.0, turn=0.0, turn_per_metre=0.0)
SQUARE = np.array([(0, 0), (4, 0), (4, 3), (0, 3)], float)


def test_a_stepped_drive_places_scans_evenly_and_faces_ahead() -> None:
    poses = true_poses(Drive(SQUARE, step=0.5))
    assert len(poses) == 23
    assert poses[0] == pytest.approx([0, 0, 0])
    assert poses[-1] == pytest.approx([0, 3, np.pi])
    assert set(np.round(np.degrees(poses[:, 2]))) == {0, 90, 180}


def test_a_waypoint_that_is_said_twice_changes_nothing() -> None:
    twice = np.repeat(SQUARE, 2, axis=0)
    np.testing.assert_array_equal(true_poses(Drive(twice, step=0.5)), true_poses(Drive(SQUARE, step=0.5)))


def test_a_drive_without_a_step_scans_at_its_waypoints_with_the_headings_given() -> None:
    poses = true_poses(Drive(SQUARE, headings=np.arange(4.0)))
    assert poses == pytest.approx(np.column_stack([SQUARE, np.arange(4.0)]))
    assert true_poses(Drive(SQUARE))[:, 2] == pytest.approx([0, np.pi / 2, np.pi, np.pi])


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 1000))
def test_perfect_wheels_report_the_true_motion_from_the_first_pose(seed: int) -> None:
    rng = np.random.default_rng(seed)
    poses = rng.uniform(-3, 3, (12, 3))
    assert wheel_odometry(poses, PERFECT, rng) == pytest.approx(in_first_frame(poses), abs=1e-9)


def test_wheels_err_by_the_stated_share_of_each_metre() -> None:
    straight = np.column_stack([np.arange(4000.0), np.zeros(4000), np.zeros(4000)])
    believed = wheel_odometry(straight, WheelNoise(0.05, 0.0, 0.02), np.random.default_rng(0))
    moves = np.array([between(a, b) for a, b in pairwise(believed)])
    assert np.linalg.norm(moves[:, :2], axis=1).std() == pytest.approx(0.05, rel=0.05)
    assert moves[:, 2].std() == pytest.approx(0.02, rel=0.05)


def test_a_slip_adds_way_that_was_not_driven() -> None:
    straight = np.column_stack([np.arange(200.0), np.zeros(200), np.zeros(200)])
    slipping = WheelNoise(0.0, 0.0, 0.0, slip=0.25, slipped=0.3)
    steps = np.diff(wheel_odometry(straight, slipping, np.random.default_rng(0))[:, 0])
    assert set(np.round(steps, 6)) == {1.0, 1.3}
    assert np.mean(steps > 1.1) == pytest.approx(0.25, abs=0.1)
