from typing import Any

import numpy as np
import pytest

from frontend.infrared_edges import infrared_edges, pair_edges
from frontend.scan import Floats, Scan, Sensor
from tests.frontend.rooms import turn

FEET = 0.3048
SENSOR = Sensor("sonar_infrared", max_range=35 * FEET, half_beam=np.radians(20), infrared_range=10 * FEET)


def scan_of(codes: dict[int, int], ranges: Floats | None = None, n: int = 64) -> Any:
    infrared = np.full(n, 31, dtype=np.int16)
    for place, code in codes.items():
        infrared[place] = code
    return Scan(turn(n), np.full(n, 2.0) if ranges is None else ranges, SENSOR, np.zeros(3), 0.0, infrared)


@pytest.mark.parametrize("silent", [30, 40])
@pytest.mark.parametrize("felt", [11, 21, 31, 34, 44])
def test_every_change_between_silence_and_detection_is_an_edge(silent: int, felt: int) -> None:
    edges = infrared_edges(scan_of(dict.fromkeys(range(10, 15), silent) | {9: felt, 15: felt}))
    assert [(edge.jamb, edge.opens) for edge in edges] == [(9, True), (15, False)]


@pytest.mark.parametrize(("before", "after"), [(31, 11), (33, 21), (30, 40)])
def test_a_change_of_strength_alone_is_no_edge(before: int, after: int) -> None:
    assert not infrared_edges(scan_of(dict(enumerate([before] * 20 + [after] * 44))))


@pytest.mark.parametrize(("feet", "edges"), [(9.9, 2), (10.1, 0)])
def test_beyond_ten_feet_the_infrared_is_ignored(feet: float, edges: int) -> None:
    ranges = np.full(64, feet * FEET)
    assert len(infrared_edges(scan_of(dict.fromkeys(range(10, 15), 30), ranges))) == edges


def test_an_opening_across_the_wrap_around_is_one_pair() -> None:
    scan = scan_of({k % 64: 30 for k in range(62, 67)})
    openings, lone = pair_edges(infrared_edges(scan), scan)
    assert not lone
    assert openings[0].readings.tolist() == [62, 63, 0, 1, 2]
    assert np.isclose(abs(openings[0].right.bearing), np.pi * (1 - 2 * 2.5 / 64))


def test_an_edge_lies_halfway_between_detection_and_silence() -> None:
    edge = infrared_edges(scan_of(dict.fromkeys(range(10, 15), 30)))[0]
    assert np.isclose(edge.bearing, turn(64)[9] + np.pi / 64)


def test_the_silent_end_of_a_part_turn_is_a_lone_edge() -> None:
    bearings = np.linspace(-1, 1, 41)
    infrared = np.where(bearings > 0.5, 30, 31).astype(np.int16)
    scan = Scan(bearings, np.full(41, 2.0), SENSOR, np.zeros(3), 0.0, infrared)
    openings, lone = pair_edges(infrared_edges(scan), scan)
    assert not openings
    assert len(lone) == 1
