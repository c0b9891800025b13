"""Latency: the lag of a turning scanner is found from the scans, and a sweep is straightened."""

import numpy as np

from frontend.scan import Floats
from slam.readers.latency import lag, straighten, turns_seen

STEP = np.radians(0.5)
BEARINGS = STEP * (np.arange(481) - 240)


def square_room(angles: Floats) -> Floats:
    """Ranges from the middle of a room of 4 × 6 m along absolute angles."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(2.0 / np.abs(np.cos(angles)), 3.0 / np.abs(np.sin(angles))))


def test_the_lag_of_the_scanner_is_found_from_the_turns_it_saw() -> None:
    rng = np.random.default_rng(3)
    wheel_times = np.linspace(0, 60, 1200)
    headings = np.cumsum(np.interp(wheel_times, np.arange(0, 61, 2.0), rng.normal(0, 0.4, 31))) * (60 / 1200)
    arrivals = np.arange(2, 58, 0.2)
    for late in (0.0, 0.3, 0.46):
        ranges = square_room(np.interp(arrivals - late, wheel_times, headings)[:, None] + BEARINGS) + rng.normal(
            0, 0.01, (280, 481)
        )
        found = lag(arrivals, turns_seen(ranges, STEP), wheel_times, headings)
        assert abs(found - late) <= 0.04


def test_a_robot_that_never_turns_has_no_lag() -> None:
    times = np.arange(10.0)
    assert lag(times, np.zeros(9), times, np.zeros(10)) == 0.0


def test_a_sweep_while_turning_is_straightened() -> None:
    headings = 0.2 * (BEARINGS / BEARINGS[-1])  # the robot turns 0.4 rad during the sweep, 0 in its middle
    ranges = square_room(BEARINGS + headings)
    sweep = np.column_stack([np.zeros((481, 2)), headings])
    bearings, straight = straighten(BEARINGS, ranges, sweep, np.zeros(3), 0.0)
    assert np.allclose(straight, square_room(bearings))
    assert (np.diff(bearings) > 0).all()
