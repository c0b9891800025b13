import numpy as np
import pytest

from frontend.scan import Floats
from frontend.sensors.transducer import (
    INCH,
    Transducer,
    absorption,
    one_way_power,
    pattern_tables,
    speed_of_sound,
    two_way_power,
)

POLAROID = Transducer()
ANGLES = np.radians(np.arange(0.0, 60.0, 0.01))


def piston_decibels(frequency: float) -> Floats:
    """The bare piston's pattern, without the obliquity of a free head."""
    return np.asarray(10 * np.log10(one_way_power(POLAROID, ANGLES, frequency) / ((1 + np.cos(ANGLES)) / 2) ** 2))


def test_the_beam_is_about_ten_degrees_wide_at_half_power() -> None:
    half = ANGLES[np.argmax(piston_decibels(50e3) < -3)]
    assert 2 * np.degrees(half) == pytest.approx(10.7, abs=0.1)
    wave_number = 2 * np.pi * 50e3 / speed_of_sound(POLAROID.celsius)
    assert wave_number * POLAROID.piston * np.sin(half) == pytest.approx(1.616, abs=2e-3)


def test_the_side_lobes_are_those_of_a_round_piston() -> None:
    level = piston_decibels(50e3)
    peaks = level[1:-1][(level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])]
    assert peaks[:3] == pytest.approx([-17.57, -23.81, -27.96], abs=0.01)


def test_four_frequencies_fill_the_nulls_of_one() -> None:
    in_the_null = slice(int(np.argmin(piston_decibels(50e3)[:2000])), None)
    one = one_way_power(POLAROID, ANGLES, 50e3)[in_the_null][0] ** 2
    assert two_way_power(POLAROID, ANGLES)[in_the_null][0] > 1000 * one


def test_the_pattern_is_one_on_the_axis_and_nothing_behind() -> None:
    assert two_way_power(POLAROID, np.array([0.0, 2.0, np.pi])) == pytest.approx([1.0, 0.0, 0.0])


def test_the_tables_fall_from_the_axis_to_the_side_for_points_and_for_walls() -> None:
    azimuths, point, wall = pattern_tables(POLAROID)
    assert point[0] == pytest.approx(1.0)
    assert 0.05 < wall[0] < 0.2  # radians of elevation that answer
    side = azimuths > np.radians(15)
    assert point[side].max() < 1e-3
    assert wall[side].max() < 1e-3 * wall[0] * 2


def test_the_chirp_of_56_pulses_lasts_1_067_ms_which_is_7_inches_one_way_and_not_3() -> None:
    assert sum(pulses for pulses, _ in POLAROID.chirp) == 56
    assert POLAROID.chirp_seconds * 1e3 == pytest.approx(1.067, abs=5e-4)
    assert POLAROID.chirp_length / INCH == pytest.approx(7.2, abs=0.05)


def test_the_wavelength_is_a_quarter_inch_and_not_half_an_inch() -> None:
    assert POLAROID.wavelength / INCH == pytest.approx(0.257, abs=0.002)
    assert speed_of_sound(20.0) / 49.41e3 / INCH == pytest.approx(0.273, abs=0.002)


def test_assuming_80_fahrenheit_at_60_lengthens_ranges_by_1_906_percent() -> None:
    fahrenheit = {degrees: (degrees - 32) / 1.8 for degrees in (60, 80)}
    stretch = Transducer(celsius=fahrenheit[60], assumed_celsius=fahrenheit[80]).stretch
    assert stretch == pytest.approx(1.01906, abs=1e-5)
    assert 7 * INCH / (stretch - 1) / 0.3048 == pytest.approx(30.6, abs=0.05)  # feet at which that is the paper's 7 in


def test_air_takes_what_the_standard_says() -> None:
    # ISO 9613-1, 20 °C: 10 kHz at 50 % and at 10 % humidity, decibels per metre.
    assert absorption(10e3, 20.0, 50.0) == pytest.approx(0.159, rel=0.05)
    assert absorption(50e3, 20.0, 50.0) == pytest.approx(1.6, rel=0.1)
    assert absorption(4e3, 20.0, 10.0) == pytest.approx(0.105, rel=0.1)
