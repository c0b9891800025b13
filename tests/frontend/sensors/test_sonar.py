import numpy as np
import pytest

from frontend.scan import Floats
from frontend.sensors.echoes import Echoes, echoes_around
from frontend.sensors.sonar import SONAR, first_echoes, half_beam_at, sonar_ranges
from frontend.sensors.surfaces import Surfaces
from frontend.sensors.transducer import FOOT, INCH, Transducer
from tests.frontend.sensors.bodies import block, body, pole, surfaces_of, wall_at

POLAROID = Transducer()
TURNS = np.radians(np.arange(0.0, 90.0, 0.5))
AHEAD = np.zeros(1)


def heard(surfaces: Surfaces, headings: Floats = TURNS, seed: int = 0) -> Floats:
    echoes = echoes_around(surfaces, np.zeros(2), POLAROID, np.random.default_rng(seed))
    return first_echoes(echoes, headings, POLAROID)


def last_heard(surfaces: Surfaces) -> float:
    """Degrees off the axis out to which anything answers."""
    return float(np.degrees(TURNS[np.isfinite(heard(surfaces))].max()))


def doorway(width: float, distance: float, material: str) -> Surfaces:
    """An open door straight ahead in a wall, and a far wall beyond."""
    left, right = (
        block(distance, width / 2, distance + 0.15, 5, material),
        block(distance, -5, distance + 0.15, -width / 2, material),
    )
    return surfaces_of(left, right, block(6, -6, 6.2, 6))


def test_a_one_inch_pole_is_heard_out_to_40_degrees() -> None:
    assert last_heard(surfaces_of(pole(2.5 * FOOT, 0.5 * INCH))) == pytest.approx(42, abs=3)


def test_a_smooth_wall_is_lost_when_aimed_at_less_than_25_degrees_from_it() -> None:
    assert 90 - last_heard(wall_at(3 * FOOT, "smooth")) == pytest.approx(25, abs=3)


def test_a_rough_wall_is_never_lost_at_that_distance() -> None:
    ranges = heard(wall_at(3 * FOOT, "rough"), np.radians(np.arange(0.0, 80.0)))
    assert np.all(np.isfinite(ranges))


def test_a_flat_smooth_wall_answers_to_about_42_degrees_through_the_side_lobes() -> None:
    # Cao & Borenstein (2002) report ±42° for a flat wall; the distance sets how far.
    assert 40 < last_heard(wall_at(2.0, "smooth")) < 55


def test_a_smooth_wall_reads_the_foot_of_its_normal_wherever_the_head_points() -> None:
    ranges = heard(wall_at(1.0, "smooth"), np.radians(np.arange(0.0, 35.0)))
    assert ranges == pytest.approx(1.0, abs=0.06)


def test_a_rough_wall_is_read_short_on_both_sides_of_its_normal() -> None:
    headings = np.radians([-60.0, -40.0, 40.0, 60.0])
    ranges = heard(wall_at(2.0), headings)
    assert np.all(ranges < 2.0 / np.cos(headings) * 0.97)
    assert ranges[:2] == pytest.approx(ranges[:1:-1], rel=0.03)


def test_a_30_inch_door_6_feet_ahead_between_rough_walls_is_closed_at_its_jambs() -> None:
    width, distance = 30 * INCH, 6 * FOOT
    assert half_beam_at(np.array([distance]), POLAROID)[0] > np.arctan(width / 2 / distance)
    ranges = [heard(doorway(width, distance, "rough"), AHEAD, seed)[0] for seed in range(8)]
    assert np.hypot(distance, width / 2) == pytest.approx(73.5 * INCH, abs=0.003)
    # The chirp is long and the jambs answer weakly so far off the axis: the reading is late, never early.
    assert np.all((np.array(ranges) > 73.4 * INCH) & (np.array(ranges) < 77 * INCH))


def test_the_same_door_is_open_where_the_beam_is_narrow_enough() -> None:
    assert heard(doorway(1.6, 4.0, "rough"), AHEAD)[0] == pytest.approx(6.0, abs=0.1)


def test_a_room_corner_of_rough_walls_reads_as_short_as_the_half_beam_says() -> None:
    corner = surfaces_of(body([(2, -30), (2, 2), (-30, 2), (-30, 2.2), (2.2, 2.2), (2.2, -30)], "rough"))
    read = np.mean([heard(corner, np.array([np.pi / 4]), seed)[0] for seed in range(8)])
    half_beam = half_beam_at(np.array([read]), POLAROID)[0]
    assert read / np.sqrt(8) == pytest.approx(np.sin(np.pi / 4) / np.sin(np.pi / 4 + half_beam), abs=0.03)


@pytest.mark.parametrize("distance", [0.5, 1.0, 1.83, 2.5, 3.5, 5.0])
def test_the_half_beam_is_what_the_end_of_a_rough_wall_shows(distance: float) -> None:
    end_of_wall = surfaces_of(block(distance, -8, distance + 0.12, 0))
    seen = [TURNS[np.isfinite(heard(end_of_wall, TURNS, seed))].max() for seed in range(5)]
    predicted = half_beam_at(np.array([distance]), POLAROID)[0]
    assert np.degrees(np.median(seen)) == pytest.approx(np.degrees(predicted), abs=1.5)


def test_the_stated_half_beam_is_cautious_inside_a_room() -> None:
    assert np.all(half_beam_at(np.linspace(0.3, 3.5, 20), POLAROID) >= SONAR.half_beam)


def test_a_slatted_closet_door_a_foot_and_a_half_away_reads_several_times_too_far() -> None:
    slats = surfaces_of(block(1.5 * FOOT, -0.6, 1.5 * FOOT + 0.05, 0.6, "slatted"), block(8, -20, 8.2, 20))
    ratios = heard(slats, np.radians(np.arange(-30.0, 31.0, 10.0))) / (1.5 * FOOT)
    assert np.all((ratios > 4) & (ratios < 6))


def test_a_mirror_makes_a_reading_much_too_long() -> None:
    oblique = body([(2, -1.5), (5, 1.5), (5.2, 1.5), (2.2, -1.5)], "smooth")
    room = surfaces_of(oblique, block(-9, 4, 9, 4.2, "smooth"))
    assert heard(room, AHEAD)[0] == pytest.approx(3.5 + 4.0, abs=0.25)


def test_nothing_is_read_beyond_35_feet_and_a_smooth_wall_at_34_still_is() -> None:
    assert heard(wall_at(34 * FOOT, "smooth"), AHEAD)[0] == pytest.approx(34 * FOOT, abs=0.05)
    assert np.isinf(heard(wall_at(36 * FOOT, "smooth"), AHEAD)[0])


def test_a_wall_inside_the_blanking_reads_the_shortest_range() -> None:
    assert heard(wall_at(0.6 * FOOT), AHEAD)[0] == pytest.approx(0.9 * FOOT, abs=0.005)


def test_a_barely_heard_echo_is_late_by_a_chirp_and_a_loud_one_is_not() -> None:
    barely, loud = (
        Echoes(np.zeros(1), np.array([3.0]), np.array([energy * POLAROID.threshold]), np.zeros(1, bool))
        for energy in (1.001, 1e6)
    )
    late, prompt = (first_echoes(echoes, AHEAD, POLAROID)[0] - 3.0 for echoes in (barely, loud))
    assert late / INCH == pytest.approx(7.2, abs=0.1)
    assert prompt == pytest.approx(0.0, abs=0.002)


def test_readings_come_in_steps_of_0_12_inches_and_follow_the_assumed_temperature() -> None:
    warm = Transducer(celsius=15.56, assumed_celsius=26.67)
    bearings = np.radians(np.arange(-20.0, 21.0))
    read = sonar_ranges(wall_at(3.0), np.zeros(3), bearings, POLAROID, np.random.default_rng(1))
    longer = sonar_ranges(wall_at(3.0), np.zeros(3), bearings, warm, np.random.default_rng(1))
    steps = read / (0.12 * INCH)
    assert steps == pytest.approx(np.round(steps), abs=1e-6)
    assert np.median(longer / read) == pytest.approx(1.0191, abs=0.003)


def test_the_beam_reads_never_far_beyond_a_rough_wall() -> None:
    room = surfaces_of(body([(-2, -2), (2, -2), (2, 2), (-2, 2)], "rough"))
    bearings = np.radians(np.linspace(-180, 180, 256, endpoint=False))
    read = sonar_ranges(room, np.zeros(3), bearings, POLAROID, np.random.default_rng(0))
    true = 2.0 / np.maximum(np.abs(np.cos(bearings)), np.abs(np.sin(bearings)))
    assert np.all(read <= true + 4 * SONAR.range_noise)
    assert read[np.argmin(np.abs(bearings))] == pytest.approx(2.0, abs=0.05)
