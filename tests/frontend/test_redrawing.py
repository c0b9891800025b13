import numpy as np
import pytest
from shapely import box

from frontend.infrared_edges import Opening, infrared_edges, pair_edges
from frontend.redrawing import opening_arc, why_closed
from frontend.scan import Floats, Scan, Sensor
from frontend.wall_lines import Profile
from tests.frontend.rooms import first_echoes, true_ranges, turn

FEET = 0.3048
SENSOR = Sensor("sonar_infrared", max_range=35 * FEET, half_beam=np.radians(10), infrared_range=10 * FEET)


def silent_between(degrees: float, ranges: Floats) -> tuple[Opening, Scan]:
    """The one gap of a scan in which the infrared is silent within so many degrees of straight ahead."""
    infrared = np.where(np.abs(turn(256)) < np.radians(degrees), 30, 31).astype(np.int16)
    scan = Scan(turn(256), ranges, SENSOR, np.zeros(3), 0.0, infrared)
    openings, _ = pair_edges(infrared_edges(scan), scan)
    return openings[0], scan


def all_measured(scan: Scan) -> Profile:
    return Profile(scan.bearings, scan.ranges, np.ones(scan.ranges.size, dtype=bool))


def test_a_gap_the_sonar_cannot_see_is_drawn_at_the_infrareds_horizon() -> None:
    opening, scan = silent_between(8, np.full(256, 2.0))
    assert why_closed(opening, all_measured(scan), scan, 0.15) is None
    assert np.allclose(opening_arc(opening, scan.ranges, scan), 10 * FEET)


def test_a_gap_the_sonar_looks_through_keeps_what_it_sees_beyond_the_horizon() -> None:
    ranges = np.where(np.abs(turn(256)) < np.radians(50), 5.0, 2.0)
    opening, scan = silent_between(50, ranges)
    assert why_closed(opening, all_measured(scan), scan, 0.15) is None
    assert np.allclose(opening_arc(opening, scan.ranges, scan), 5.0)


@pytest.mark.parametrize("wall", [2.95, 3.0, 3.04])
def test_a_wall_at_the_horizon_only_fades_out(wall: float) -> None:
    opening, scan = silent_between(8, np.full(256, wall))
    assert "fades out" in str(why_closed(opening, all_measured(scan), scan, 0.15))


def test_a_surface_that_the_infrared_cannot_feel_is_no_opening() -> None:
    opening, scan = silent_between(60, np.full(256, 2.0))
    assert "sees a surface 2.00 m away" in str(why_closed(opening, all_measured(scan), scan, 0.15))


def test_a_corner_read_short_before_the_horizon_is_no_opening() -> None:
    """Both walls fade out at 10 ft, but in the corner between them the beam reads 2.6 m, as if both ended there."""
    truth, _ = true_ranges(box(-2, -2, 2.4, 2.4), np.zeros(3), turn(256))
    infrared = np.where(truth < 10 * FEET, 31, 30).astype(np.int16)
    scan = Scan(turn(256), first_echoes(truth, SENSOR.half_beam), SENSOR, np.zeros(3), 0.0, infrared)
    openings, _ = pair_edges(infrared_edges(scan), scan)
    short = np.minimum(scan.ranges, 2.6)
    profile = Profile(turn(256), np.where(truth > 2.6, short, truth), truth <= 2.6)
    assert "fades out" in str(why_closed(openings[0], profile, scan, 0.15))


def test_a_reading_nearer_than_a_corner_can_shorten_it_is_a_wall_of_its_own() -> None:
    """The wall beyond would fade out at the edge, but the jamb stands a metre in front of it."""
    bearings = turn(256)
    ranges = np.where(np.abs(bearings) < np.radians(12), 1.9, 3.0 / np.cos(np.abs(bearings) - np.radians(12)))
    opening, scan = silent_between(8, np.minimum(ranges, 6.0))
    assert why_closed(opening, all_measured(scan), scan, 0.15) is None


def test_an_echo_from_beyond_the_horizon_opens_no_more_than_its_own_beam() -> None:
    ranges = np.where(np.abs(turn(256)) < np.radians(4), 7.0, np.where(np.abs(turn(256)) < np.radians(15), 3.5, 2.0))
    opening, scan = silent_between(15, ranges)
    arc = opening_arc(opening, ranges, scan)
    assert np.max(arc) == 7.0
    assert np.isclose(np.mean(arc == 7.0), 4 / 15, atol=0.1)
    assert np.min(arc) == 3.5
