import numpy as np
import pytest

from planners.headings import least_turning

CIRCLE = (0.0, 2 * np.pi)


def turning(headings: np.ndarray) -> float:
    return float(np.abs(np.diff(headings)).sum())


def test_one_heading_serves_all_legs_that_share_one() -> None:
    headings = least_turning([(0.5, 0.5), (0.0, 1.0), (0.2, 2.0), CIRCLE], [CIRCLE] * 3)
    assert np.allclose(headings, 0.5)


def test_a_turn_waits_until_a_leg_demands_it_and_goes_no_farther() -> None:
    headings = least_turning([(0.0, 0.0), (-1.0, 1.0), (1.0, 2.0), (0.5, 3.0)], [(-1.0, 3.0)] * 3)
    assert np.allclose(headings, [0, 0, 1, 1])


def test_on_a_full_circle_the_robot_turns_the_short_way() -> None:
    assert turning(least_turning([(6.0, 6.0), (0.2, 0.2)], [CIRCLE])) == pytest.approx(0.2 - 6.0 + 2 * np.pi)


def test_where_the_short_way_is_barred_it_turns_the_long_way() -> None:
    assert turning(least_turning([(6.0, 6.0), (0.2, 0.2)], [(0.1, 6.1)])) == pytest.approx(5.8)


def test_free_headings_take_what_their_neighbours_need() -> None:
    assert np.allclose(least_turning([CIRCLE, (1.0, 1.0), CIRCLE], [CIRCLE, CIRCLE]), 1.0)
