"""Corners the beam cannot see into: inferred where two square walls run on to meet, and never against a reading."""

import numpy as np
import pytest
import shapely
from shapely import box
from shapely.geometry.base import BaseGeometry

from frontend.contour import ContourKind, ContourSettings, EdgeKind, trace
from frontend.fusion import FusedScan, FusionSettings, ReadingKind, fuse
from frontend.scan import Floats, Scan, Sensor
from tests.frontend.rooms import first_echoes, true_ranges, turn

BEARINGS = turn(256)
ROOM = box(0, 0, 4, 3)
POSE = np.array([1.8, 1.3, 0.2])


def heard(room: BaseGeometry, degrees: float, silent: Floats | None = None) -> tuple[FusedScan, Floats]:
    """The room as a beam so wide hears it; silent (n,): where an infrared that works to 10 ft felt nothing."""
    sensor = Sensor("sonar_infrared", 10.7, half_beam=np.radians(degrees), range_noise=0.005, infrared_range=3.048)
    truth, _ = true_ranges(room, POSE, BEARINGS)
    noisy = first_echoes(truth, sensor.half_beam) + np.random.default_rng(0).normal(0.0, 0.005, 256)
    codes = None if silent is None else np.where(silent, 30, 31).astype(np.int16)
    return fuse(Scan(BEARINGS, noisy, sensor, np.zeros(3), 0.0, codes), FusionSettings()), truth


@pytest.mark.parametrize("degrees", [5, 10, 20])
def test_the_corners_of_an_empty_room_come_back_and_are_marked_as_inferred(degrees: float) -> None:
    fused, truth = heard(ROOM, degrees)
    inferred = fused.kinds == ReadingKind.INFERRED
    assert inferred.any()
    assert np.max(np.abs(fused.ranges - truth)[inferred]) < 0.08
    assert np.all(fused.vouched[inferred] < fused.ranges[inferred])
    assert np.mean(truth - fused.ranges) < 0.4 * np.mean(truth - fused.vouched) + 0.002


def test_what_is_inferred_is_no_surface() -> None:
    fused, _ = heard(ROOM, 10)
    contour = trace(fused, ContourSettings())
    at = contour.kinds == ContourKind.INFERRED
    assert at.any()
    assert np.all(contour.edge_kinds[at] == EdgeKind.NO_RETURN)
    assert not np.isin(contour.reading[at], contour.surface().reading).any()


def test_a_thing_that_stands_in_the_corner_keeps_it_closed() -> None:
    cupboard = box(3.3, 2.2, 4, 3)
    fused, truth = heard(ROOM.difference(cupboard), 10)
    ends = POSE[:2] + fused.ranges[:, None] * np.column_stack([np.cos(BEARINGS + POSE[2]), np.sin(BEARINGS + POSE[2])])
    assert not shapely.contains_xy(cupboard.buffer(-0.05), *ends.T).any()
    assert np.all(fused.ranges < truth + 0.05)


def test_where_the_infrared_feels_no_wall_there_is_no_corner() -> None:
    corner = np.arctan2(3 - POSE[1], 4 - POSE[0]) - POSE[2]
    fused, _ = heard(ROOM, 10, np.abs(BEARINGS - corner) < np.radians(4))
    there = np.abs(BEARINGS - corner) < np.radians(3)
    assert not np.any(fused.kinds[there] == ReadingKind.INFERRED)


def test_walls_that_are_not_square_are_not_continued() -> None:
    wedge = shapely.Polygon([(0, 0), (4, 0), (2.5, 3), (0, 3)])
    fused, truth = heard(wedge, 10)
    sharp = np.arctan2(0 - POSE[1], 4 - POSE[0]) - POSE[2]
    assert not np.any(fused.kinds[np.abs(BEARINGS - sharp) < np.radians(8)] == ReadingKind.INFERRED)
    assert np.all(fused.ranges < truth + 0.05)
