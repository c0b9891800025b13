from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Polygon

from frontend.contour import ContourKind, ContourSettings, EdgeKind, trace
from frontend.fusion import FusionSettings, fuse
from frontend.rigid_motion import transform
from frontend.scan import Floats, Scan, Sensor
from tests.frontend.rooms import FURNISHED, L_ROOM, lidar_scan, traced, true_ranges, turn

POSE = np.array([3.0, 1.5, 0.4])


@settings(deadline=None, max_examples=20)
@given(st.lists(st.floats(0.0, 40.0) | st.sampled_from([np.nan, np.inf]), min_size=8, max_size=40), st.booleans())
def test_the_free_space_is_valid_whatever_was_read(ranges: list[float], full: bool) -> None:
    n = len(ranges)
    bearings = turn(n) if full else np.linspace(-1.5, 1.5, n)
    scan = Scan(bearings, np.array(ranges), Sensor("lidar", 30.0), np.zeros(3), 0.0)
    contour = trace(fuse(scan, FusionSettings()), ContourSettings())
    assert contour.free_space.is_valid
    assert contour.free_space.exterior.is_ccw


def test_every_point_keeps_where_it_came_from() -> None:
    contour = traced(FURNISHED, POSE)
    measured = contour.kinds == ContourKind.MEASURED
    assert np.array_equal(contour.reading[measured], np.arange(360))
    gaps = np.linalg.norm(np.diff(contour.points, axis=0), axis=1)
    assert np.max(gaps) <= ContourSettings().filler_spacing + 1e-9
    assert np.all(np.diff(contour.arc_length) >= 0)


def test_a_part_turn_is_closed_through_the_sensor() -> None:
    scan = lidar_scan(L_ROOM, POSE)
    half = np.abs(scan.bearings) < 1.5
    sensor = Sensor("lidar", 30.0, range_noise=0.01, mount=(0.2, -0.1, 0.5))
    contour = trace(
        fuse(Scan(scan.bearings[half], scan.ranges[half], sensor, np.zeros(3), 0.0), FusionSettings()),
        ContourSettings(),
    )
    side = np.flatnonzero(contour.kinds == ContourKind.SIDE)
    assert np.allclose(contour.points[side], [[0.2, -0.1]])
    assert np.sum(contour.edge_kinds == EdgeKind.SIDE) == 2


@pytest.mark.parametrize(("n", "recall", "precision"), [(180, 0.9, 0.75), (360, 0.95, 0.8), (720, 0.99, 0.85)])
def test_fake_edges_are_told_from_surface(n: int, recall: float, precision: float) -> None:
    hits = misses = false = 0
    for pose in np.random.default_rng(3).uniform([0.3, 0.3, -3], [7.7, 2.0, 3], (30, 3)):
        fake, same_wall = between_walls(FURNISHED, pose, n)
        contour = traced(FURNISHED, pose, n)
        called = contour.edge_kinds[contour.vertices] == EdgeKind.OCCLUSION
        hits += np.sum(called & fake)
        misses += np.sum(~called & fake)
        false += np.sum(called & same_wall)
    assert hits / (hits + misses) > recall
    assert hits / (hits + false) > precision


def between_walls(room: Polygon, pose: Floats, n: int) -> Any:
    """Edges (n,) between readings of two walls that no wall joins, and those on one wall."""
    ranges, wall = true_ranges(room, pose, turn(n))
    ends = transform(ranges[:, None] * np.column_stack([np.cos(turn(n)), np.sin(turn(n))]), pose)
    after = np.roll(ends, -1, axis=0)
    off = shapely.distance(room.boundary, shapely.points((ends + after) / 2))
    same_wall = wall == np.roll(wall, -1)
    return ~same_wall & (off > 0.08) & (np.linalg.norm(after - ends, axis=1) > 0.25), same_wall


def test_normals_face_the_sensor_and_stand_on_the_walls() -> None:
    surface = traced(L_ROOM, np.array([1.5, 1.2, 0.0])).surface()
    assert np.all(np.sum(surface.normals * surface.points, axis=1) < 0)
    off_axis = np.min(np.abs(surface.normals), axis=1)
    assert np.median(off_axis) < 0.08
    assert surface.points.shape[0] > 300


def test_a_silent_reading_leaves_no_surface() -> None:
    scan = lidar_scan(L_ROOM, POSE)
    ranges = scan.ranges.copy()
    ranges[100:110] = np.inf
    contour = trace(
        fuse(Scan(scan.bearings, ranges, scan.sensor, np.zeros(3), 0.0), FusionSettings()), ContourSettings()
    )
    at = contour.vertices
    assert np.all(contour.edge_kinds[at[99:110]] == EdgeKind.NO_RETURN)
    assert not np.isin(np.arange(100, 110), contour.surface().reading).any()
