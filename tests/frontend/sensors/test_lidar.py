from dataclasses import replace

import numpy as np
import pytest

from frontend.sensors.lidar import DROPOUT, LIDAR, lidar_ranges
from tests.frontend.sensors.bodies import wall_at

FAN = np.radians(np.linspace(-60, 60, 4001))


def test_ranges_scatter_around_the_truth_by_the_stated_noise() -> None:
    ranges = lidar_ranges(wall_at(2.0), np.zeros(3), FAN, LIDAR, np.random.default_rng(0))
    errors = (ranges - 2.0 / np.cos(FAN))[np.isfinite(ranges)]
    assert errors.std() == pytest.approx(LIDAR.range_noise, rel=0.05)
    assert errors.mean() == pytest.approx(0.0, abs=1e-3)


def test_some_readings_are_lost_and_the_far_ones_all_are() -> None:
    near = lidar_ranges(wall_at(2.0), np.zeros(3), FAN, LIDAR, np.random.default_rng(0))
    assert np.isinf(near).mean() == pytest.approx(DROPOUT, rel=0.6)
    far = lidar_ranges(wall_at(2.0), np.zeros(3), FAN, replace(LIDAR, max_range=1.0), np.random.default_rng(0))
    assert np.all(np.isinf(far))


def test_the_pose_turns_the_fan() -> None:
    exact = replace(LIDAR, range_noise=0.0, quantum=0.0)
    pose = np.array([1.0, 0.5, np.pi / 3])
    ranges = lidar_ranges(wall_at(2.0), pose, np.array([-np.pi / 3]), exact, np.random.default_rng(1))
    assert ranges == pytest.approx([1.0])
