"""Steady motion: the forecast that usually held is asked, and its doubt covers what nobody saw."""

import numpy as np
import pytest

from backend.arcs import Floats
from backend.steady_motion import SteadyMotion

DOUBTS = (0.5, 0.3)


def after(moves: list[Floats], seconds: list[float]) -> SteadyMotion:
    motion = SteadyMotion(DOUBTS, 30)
    for move, time in zip(moves, seconds, strict=True):
        motion.see(move, time)
    return motion


def test_a_robot_of_steady_speed_is_expected_to_go_farther_in_more_time() -> None:
    times = [1.0, 2.0, 0.5, 1.5, 1.0, 3.0]
    motion = after([np.array([0.2 * time, 0, 0]) for time in times], times)
    np.testing.assert_allclose(motion.foretell(2.5)[0], [0.5, 0, 0], atol=1e-9)


def test_a_log_written_step_by_step_is_expected_to_go_on_so_whatever_its_clock_says() -> None:
    times = [1.0, 4.0, 0.5, 9.0, 1.0, 3.0]
    motion = after([np.array([0.6, 0, 0])] * 6, times)
    np.testing.assert_allclose(motion.foretell(0.1)[0], [0.6, 0, 0])


def test_the_doubt_reaches_a_robot_that_turns_back() -> None:
    turning = after([np.array([0, 0, 0.6])] * 6, [1.0] * 6)
    expected, covariance = turning.foretell(1.0)
    assert 3 * np.sqrt(covariance[2, 2]) > 2 * expected[2]


def test_where_the_robot_slid_it_is_expected_to_go_on_with_more_doubt() -> None:
    motion = after([np.array([0.5, 0, 0])] * 6, [1.0] * 6)
    before = motion.foretell(1.0)
    motion.slide()
    after_one = motion.foretell(1.0)
    np.testing.assert_allclose(after_one[0], before[0])
    np.testing.assert_allclose(after_one[1], 2 * before[1])


def test_after_moves_that_nobody_knows_nothing_is_expected_and_nothing_is_learnt() -> None:
    motion = after([np.array([0.5, 0, 0])] * 6, [1.0] * 6)
    motion.lose()
    expected, covariance = motion.foretell(1.0)
    np.testing.assert_array_equal(expected, np.zeros(3))
    motion.see(np.array([4.0, 2.0, 1.0]), 1.0)  # from where it was lost, which was nowhere
    np.testing.assert_array_equal(motion.foretell(1.0)[0], np.zeros(3))
    assert motion.foretell(1.0)[1][0, 0] < covariance[0, 0]


def test_at_a_new_place_only_the_usual_doubt_is_left() -> None:
    motion = after([np.array([0.5, 0, 0])] * 6, [1.0] * 6)
    motion.lose()
    motion.slide()
    motion.arrive()
    assert motion.foretell(1.0)[1][0, 0] == pytest.approx(DOUBTS[0] ** 2)
