"""Perception: one scan becomes surface, knots and a view that all speak of the same room."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import Point, box

from frontend.fusion import ReadingKind
from frontend.rigid_motion import transform
from frontend.scan import Scan
from slam.perception import FrontendSettings, Percept, perceive
from tests.simulated_drives import BEARINGS, drive, world_of

POSE = np.array([2.0, 1.5, 0.4])
ROOM = box(0, 0, 5, 4)


@pytest.fixture(scope="module")
def scan() -> Scan:
    return drive(world_of(ROOM), POSE[None], 0)[0]


@pytest.fixture(scope="module")
def percept(scan: Scan) -> Percept:
    return perceive(scan, FrontendSettings())


def test_the_surface_lies_on_the_walls_and_faces_the_sensor(percept: Percept) -> None:
    placed = transform(percept.surface.points, POSE)
    assert np.median([ROOM.exterior.distance(Point(point)) for point in placed]) < 0.015
    assert np.all(np.sum(percept.surface.normals * -percept.surface.points, axis=1) > 0)
    assert len(percept.surface.points) > 0.9 * len(BEARINGS)


def test_the_view_is_the_room(percept: Percept) -> None:
    placed = percept.view
    area = placed.free_space.area
    assert area == pytest.approx(ROOM.area, rel=0.02)
    np.testing.assert_array_equal(placed.origin, [0, 0])


def test_landmark_knots_lie_at_the_corners_of_the_room(percept: Percept) -> None:
    corners = np.array(ROOM.exterior.coords)[:-1]
    placed = transform(percept.knots.positions, POSE)
    assert len(placed) >= 3
    assert np.max(np.linalg.norm(placed[:, None] - corners[None], axis=2).min(axis=1)) < 0.1


def test_the_parts_of_the_knots_belong_together(percept: Percept) -> None:
    count = len(percept.knots.positions)
    assert percept.knots.turns.shape == percept.knots.headings.shape == (count,)
    assert percept.knots.covariances.shape == (count, 2, 2)
    assert np.all(np.linalg.eigvalsh(percept.knots.covariances) > 0)


def test_the_scan_is_kept_as_it_was_read(scan: Scan, percept: Percept) -> None:
    assert percept.scan is scan


@pytest.mark.parametrize("silence", [np.inf, np.nan])
def test_a_scan_without_any_reading_is_perceived_as_no_surface(scan: Scan, silence: float) -> None:
    blind = perceive(replace(scan, ranges=np.full(len(BEARINGS), silence)), FrontendSettings())
    assert len(blind.surface.points) == 0
    assert len(blind.knots.positions) == 0
    assert not np.any(blind.fused.kinds == ReadingKind.MEASURED)


def test_perceiving_does_not_write_into_the_scan(scan: Scan) -> None:
    before = scan.ranges.copy()
    perceive(scan, FrontendSettings())
    np.testing.assert_array_equal(scan.ranges, before)
