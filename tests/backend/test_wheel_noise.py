"""What wheels are worth."""

import numpy as np

from backend.odometry import OdometrySettings
from backend.wheel_noise import driven

SETTINGS = OdometrySettings(least_distance=0.0, least_turn=0.0)


def test_a_straight_way_errs_along_and_by_its_bend() -> None:
    move = driven(np.array([2.0, 0.0, 0.0]), SETTINGS)
    bend = SETTINGS.turn_per_metre * 2
    assert np.isclose(move.covariance[0, 0], (SETTINGS.distance_noise * 2) ** 2)
    assert np.isclose(move.covariance[2, 2], bend**2)
    # The chord swings by half the bend.
    assert np.isclose(move.covariance[1, 2], bend * bend * 2 / 2)


def test_a_turn_on_the_spot_moves_nothing() -> None:
    covariance = driven(np.array([0.0, 0.0, 1.0]), SETTINGS).covariance
    assert np.isclose(covariance[2, 2], SETTINGS.turn_noise**2)
    assert np.allclose(covariance[:2], 0)
