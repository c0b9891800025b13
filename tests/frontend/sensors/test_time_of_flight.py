from dataclasses import replace

import numpy as np
import pytest

from frontend.sensors.time_of_flight import TIME_OF_FLIGHT, time_of_flight_ranges
from tests.frontend.sensors.bodies import block, surfaces_of, wall_at

EXACT = replace(TIME_OF_FLIGHT, range_noise=0.0)
AHEAD = np.zeros(1)


def test_a_wall_across_the_cone_reads_between_its_nearest_point_and_its_rim() -> None:
    read = time_of_flight_ranges(wall_at(2.0), np.zeros(3), AHEAD, EXACT, np.random.default_rng(0))[0]
    assert 2.0 <= read <= 2.0 / np.cos(EXACT.half_beam)


def test_a_post_inside_the_cone_hides_the_wall_behind() -> None:
    scene = surfaces_of(block(1.0, 0.05, 1.1, 0.25), block(3.0, -5, 3.1, 5))
    read = time_of_flight_ranges(scene, np.zeros(3), AHEAD, EXACT, np.random.default_rng(0))[0]
    assert read == pytest.approx(1.0, abs=0.05)


def test_two_walls_closer_than_the_pulse_melt_into_one() -> None:
    scene = surfaces_of(block(1.0, 0.0, 1.5, 5), block(1.1, -5, 1.5, 0.0))
    read = time_of_flight_ranges(scene, np.zeros(3), AHEAD, EXACT, np.random.default_rng(0))[0]
    assert 1.02 < read < 1.1


def test_a_dark_wall_is_lost_sooner_than_a_white_one() -> None:
    rng = np.random.default_rng(0)
    white, dark = (
        time_of_flight_ranges(wall_at(2.5, name), np.zeros(3), AHEAD, EXACT, rng)[0] for name in ("rough", "dark")
    )
    assert np.isfinite(white)
    assert np.isinf(dark)


def test_nothing_is_read_beyond_the_reach() -> None:
    read = time_of_flight_ranges(wall_at(4.5), np.zeros(3), AHEAD, EXACT, np.random.default_rng(0))
    assert np.all(np.isinf(read))
