"""Range arcs: what regions of constant depth say of walls and edges."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from frontend.arc_fit import wall_ranges
from frontend.range_arcs import ArcSettings, range_arcs
from frontend.rigid_motion import wrap
from frontend.scan import Floats, Scan
from frontend.sensors.sonar import SONAR

BEARINGS = np.linspace(-np.pi, np.pi, 256, endpoint=False)
BEAM = SONAR.beam


def scan_of(ranges: Floats) -> Scan:
    return Scan(BEARINGS, ranges, SONAR, np.zeros(3), 0.0)


def nearest_of(*walls: tuple[float, float]) -> Floats:
    """What walls (range and bearing of the foot) read together: the first echo counts."""
    profiles = [wall_ranges(np.asarray(wrap(BEARINGS - b)), np.array([r, b, 1.04]), BEAM) for r, b in walls]
    return np.asarray(np.min([*profiles, np.full(BEARINGS.size, 9.0)], axis=0), np.float64)


@settings(deadline=None, max_examples=15)
@given(st.floats(0.5, 3.0), st.floats(-3.0, 3.0), st.integers(0, 1000))
def test_the_foot_of_a_wall_is_found_to_a_centimetre_and_a_degree(distance: float, bearing: float, seed: int) -> None:
    ranges = nearest_of((distance, bearing)) + np.random.default_rng(seed).normal(0, 0.01, BEARINGS.size)
    arcs = range_arcs(scan_of(ranges), ArcSettings())
    assert arcs.firm[0]
    assert abs(arcs.ranges[0] - distance) < 0.01
    assert abs(wrap(arcs.wall_bearings[:1] - bearing)[0]) < np.radians(1.5)


def test_a_corridor_gives_both_its_walls() -> None:
    arcs = range_arcs(scan_of(nearest_of((0.9, np.pi / 2), (1.1, -np.pi / 2))), ArcSettings())
    assert np.sum(arcs.firm) == 2
    assert np.allclose(np.sort(arcs.ranges[arcs.firm]), [0.9, 1.1], atol=0.01)


def test_a_pole_is_an_arc_that_is_no_sure_wall_and_its_bearing_is_the_middle() -> None:
    half = float(np.interp(1.5, *BEAM.T))
    ranges = np.where(np.abs(BEARINGS - 0.3) < 0.9 * half, 1.5, 9.0)
    arcs = range_arcs(scan_of(ranges), ArcSettings())
    assert not arcs.firm[0]
    assert abs(arcs.ranges[0] - 1.5) < 0.01
    assert abs(arcs.edge_bearings[0] - 0.3) < 3 * arcs.edge_spreads[0]
    assert arcs.edge_spreads[0] < np.radians(4)


def test_a_turn_of_the_head_turns_every_arc() -> None:
    ranges = nearest_of((0.9, 0.7), (1.4, -0.9))
    arcs, turned = (range_arcs(scan_of(np.roll(ranges, shift)), ArcSettings()) for shift in (0, 40))
    first, second = np.argsort(arcs.ranges), np.argsort(turned.ranges)
    assert np.allclose(arcs.ranges[first], turned.ranges[second], atol=1e-6)
    step = 40 * 2 * np.pi / 256
    assert np.allclose(wrap(turned.wall_bearings[second] - arcs.wall_bearings[first] - step), 0, atol=1e-4)


def test_silence_has_no_arcs() -> None:
    assert len(range_arcs(scan_of(np.full(256, np.inf)), ArcSettings()).ranges) == 0
