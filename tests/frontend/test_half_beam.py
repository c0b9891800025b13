"""The half-beam as the readings themselves tell it: close, and never wider than it is."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from frontend.half_beam import BeamArcs, HalfBeamSettings, beam_arcs, with_estimated_beam
from frontend.scan import Scan, Sensor
from frontend.sensors.sonar import SONAR, half_beam_at
from frontend.sensors.transducer import Transducer
from slam.simulation.record import Recipe, drive_through
from tests.frontend.rooms import first_echoes, true_ranges, turn
from tests.simulated_drives import world_of

OPINIONS = HalfBeamSettings()
BEARINGS = turn(256)
UNTOLD = Sensor("sonar_infrared", 10.7, 0.27, range_noise=0.005, quantum=0.003)


def room_scans(degrees: float, seed: int, count: int = 6) -> list[Scan]:
    """Scans of one plain room from anywhere in it, by a sonar that does not say how wide it hears."""
    rng = np.random.default_rng(seed)
    width, depth = rng.uniform(3.5, 6.0, 2)
    scans = []
    for _ in range(count):
        pose = np.array([*rng.uniform(1.0, [width - 1, depth - 1]), rng.uniform(-np.pi, np.pi)])
        truth, _ = true_ranges(box(0, 0, width, depth), pose, BEARINGS)
        noisy = first_echoes(truth, np.radians(degrees)) + rng.normal(0.0, UNTOLD.range_noise, 256)
        scans.append(Scan(BEARINGS, np.round(noisy / 0.003) * 0.003, UNTOLD, np.zeros(3), 0.0))
    return scans


@settings(deadline=None, max_examples=12)
@given(st.sampled_from([5.0, 10.0, 20.0]), st.integers(0, 10_000))
def test_the_estimate_is_within_two_degrees_and_never_too_wide(degrees: float, seed: int) -> None:
    """What is heard is whole readings: the beam of 5° at steps of 1.4° hears 4.2°."""
    step = 360 / 256
    heard = np.floor(degrees / step) * step
    sensor = with_estimated_beam(UNTOLD, beam_arcs(room_scans(degrees, seed), OPINIONS), OPINIONS)
    assert sensor is not None
    estimated = np.degrees([angle for _, angle in sensor.half_beams])
    assert np.all(estimated < degrees)
    assert np.all(estimated < heard + 0.35)
    assert estimated.max() > heard - 2.0


def test_a_thin_beam_is_not_taken_for_a_wide_one() -> None:
    sensor = with_estimated_beam(UNTOLD, beam_arcs(room_scans(0.5, 1), OPINIONS), OPINIONS)
    assert sensor is None or sensor.half_beam < np.radians(1.0)


def test_too_few_arcs_tell_nothing() -> None:
    arcs = BeamArcs(np.array([1.0, 2.0]), np.radians([10.0, 10.0]), np.radians([0.2, 0.2]))
    assert with_estimated_beam(UNTOLD, arcs, OPINIONS) is None
    assert beam_arcs([], OPINIONS).distances.size == 0


def test_poles_answer_over_the_whole_beam_too_but_do_not_rise_like_walls() -> None:
    ranges = np.where(np.abs(BEARINGS) < np.radians(25), 1.5, 4.0)
    arcs = beam_arcs([Scan(BEARINGS, ranges, UNTOLD, np.zeros(3), 0.0)], OPINIONS)
    assert not np.any(np.abs(arcs.distances - 1.5) < 0.1)


def test_the_simulated_transducer_is_never_called_wider_than_it_hears_rough_walls() -> None:
    world = world_of(box(0, 0, 5.2, 3.9))
    rng = np.random.default_rng(3)
    poses = np.column_stack([rng.uniform(0.7, 4.5, 12), rng.uniform(0.7, 3.2, 12), rng.uniform(-3, 3, 12)])
    scans = drive_through(world, poses, Recipe("sonar_infrared", seed=2))
    sensor = with_estimated_beam(SONAR, beam_arcs(scans, OPINIONS), OPINIONS)
    assert sensor is not None
    metres, angles = np.array(sensor.half_beams).T
    assert np.all(angles < half_beam_at(metres, Transducer()))
    assert np.max(angles / half_beam_at(metres, Transducer())) > 0.4


@pytest.mark.parametrize("metres", [1.0, 1.5])
def test_the_beam_never_widens_with_the_range(metres: float) -> None:
    near, far = np.full(20, 0.8), np.full(20, metres + 1)
    arcs = BeamArcs(np.append(near, far), np.radians(np.repeat([8.0, 12.0], 20)), np.full(40, 1e-3))
    sensor = with_estimated_beam(UNTOLD, arcs, OPINIONS)
    assert sensor is not None
    assert np.all(np.diff([angle for _, angle in sensor.half_beams]) <= 0)
