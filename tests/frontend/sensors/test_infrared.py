from dataclasses import replace

import numpy as np
import pytest

from frontend.scan import Floats
from frontend.sensors.infrared import InfraredDetector, codes_of, infrared_codes
from frontend.sensors.surfaces import MATERIALS, Surfaces
from frontend.sensors.transducer import FOOT, INCH
from tests.frontend.sensors.bodies import block, surfaces_of, wall_at

THREE = InfraredDetector(flicker=0.0)
FOUR = replace(THREE, leds=4)


def code(surfaces: Surfaces, detector: InfraredDetector = THREE) -> int:
    rng = np.random.default_rng(0)
    return int(infrared_codes(surfaces, np.zeros(3), np.zeros(1), detector, rng)[0])


@pytest.mark.parametrize(("detector", "feet"), [(THREE, 10), (FOUR, 18)])
def test_three_leds_reach_10_feet_and_four_reach_18(detector: InfraredDetector, feet: int) -> None:
    assert code(wall_at((feet - 0.1) * FOOT), detector) == 10 * detector.leds + 1
    assert code(wall_at((feet + 0.1) * FOOT), detector) == 10 * detector.leds


def test_code_11_comes_from_a_dark_surface_at_1_5_feet_and_from_a_bright_one_at_8_2() -> None:
    assert code(wall_at(1.5 * FOOT, "dark")) == code(wall_at(1.5 * FOOT, "slatted")) == code(wall_at(8.2 * FOOT)) == 11


def test_a_nearer_wall_needs_fewer_leds_and_then_a_less_sensitive_comparator() -> None:
    feet = np.linspace(0.5, 17.5, 60)
    codes = np.array([code(wall_at(f * FOOT), FOUR) for f in feet])
    strength = 10 * (4 - codes // 10) + codes % 10  # fewer LEDs first, then the comparator
    assert np.all(np.diff(strength) <= 0)
    assert set(codes // 10) == {1, 2, 3, 4}
    assert {11, 12, 13, 14} <= set(codes)


def test_firing_stops_at_the_first_led_that_is_answered() -> None:
    brightness: Floats = np.array([0.0, 1e-3, 0.1, 10.0])
    codes = codes_of(brightness, FOUR)
    assert codes[0] == 40
    assert np.all(np.diff(codes // 10) <= 0)


def test_the_edge_of_a_doorway_is_found_within_one_bearing_of_256() -> None:
    step = 2 * np.pi / 256
    jamb = 15 * INCH
    bearings = np.linspace(-20.0, 20.0, 41) * step + 0.3 * step
    room = surfaces_of(block(6 * FOOT, jamb, 6 * FOOT + 0.1, 5), block(6 * FOOT, -5, 6 * FOOT + 0.1, -jamb))
    felt = infrared_codes(room, np.zeros(3), bearings, InfraredDetector(), np.random.default_rng(3)) % 10 > 0
    edges = bearings[:-1][np.diff(felt.astype(int)) != 0] + step / 2
    assert edges == pytest.approx([-np.arctan2(jamb, 6 * FOOT), np.arctan2(jamb, 6 * FOOT)], abs=step)
    assert step / 2 * 6 * FOOT / INCH == pytest.approx(0.88, abs=0.01)  # the ceiling of 256 bearings


def test_a_rough_wall_looked_at_aslant_is_felt_farther_than_a_smooth_one() -> None:
    rough, smooth = (replace(MATERIALS[name], reflectance=0.8) for name in ("rough", "smooth"))
    aslant: Floats = np.array([65.0 * np.pi / 180])
    rng = np.random.default_rng(0)
    codes = [infrared_codes(wall_at(1.1, wall), np.zeros(3), aslant, THREE, rng)[0] for wall in (rough, smooth)]
    assert codes[0] % 10 > 0
    assert codes[1] == 30


def test_nothing_in_sight_reads_all_leds_and_no_comparator() -> None:
    assert code(surfaces_of(block(-3, -1, -2, 1))) == 30
