from typing import Any

import numpy as np
import pytest
import shapely
from shapely import LineString, box

from frontend.contour import ContourSettings, EdgeKind, trace
from frontend.fusion import FusionSettings, fuse
from frontend.primal_sketch import KnotKind, SketchSettings, chains, sketch
from frontend.rigid_motion import transform
from frontend.scan import Scan, Sensor
from tests.frontend.rooms import FURNISHED, L_ROOM, corners_of, lidar_scan, sketched, traced

FEET = 0.3048
POSE = np.array([1.8, 1.5, 0.3])


def nearest(a: Any, b: Any) -> Any:
    return np.min(np.linalg.norm(a[:, None] - b[None], axis=2), axis=1)


def test_the_corners_of_a_room_are_landmarks_where_they_are() -> None:
    seen = sketched(L_ROOM, POSE)
    assert np.sum(nearest(corners_of(L_ROOM, POSE), seen.positions[seen.landmark]) < 0.03) >= 5  # one wall is grazing
    assert np.all(nearest(seen.positions[seen.landmark], corners_of(L_ROOM, POSE)) < 0.1)


def test_room_corners_turn_left_and_corners_that_stand_out_turn_right() -> None:
    seen = sketched(L_ROOM, POSE)
    corners = seen.kinds == KnotKind.CORNER
    out = nearest(seen.positions, transform(np.array([[3.5, 2.5]]) - POSE[:2], np.array([0, 0, -POSE[2]]))) < 0.1
    assert np.all(np.isclose(np.abs(seen.turns[corners]), np.pi / 2, atol=0.1))
    assert np.all(seen.turns[corners & ~out] > 0)
    assert np.all(seen.turns[corners & out] < 0)


@pytest.mark.parametrize("move", [(0.0, -2 * FEET), (2 * FEET, 0.0)])
def test_knots_are_found_again_after_two_feet(move: Any) -> None:
    here, there = sketched(FURNISHED, POSE), sketched(FURNISHED, POSE + np.array([*move, 0.0]), seed=1)
    placed = transform(there.positions[there.landmark], np.zeros(3))
    turn = np.array([0.0, 0.0, -POSE[2]])
    placed = placed + transform(np.array([move]), turn)
    again = nearest(here.positions[here.landmark], placed) < 0.1
    assert np.mean(again) > 0.7


def test_a_far_change_of_the_room_moves_no_near_knot() -> None:
    room = box(0, 0, 8, 6)
    plain, changed = sketched(room, POSE), sketched(room.difference(box(7.0, 2.5, 8.0, 3.5)), POSE)
    near = plain.landmark & (np.linalg.norm(plain.positions - corners_of(room, POSE)[0], axis=1) < 0.2)
    assert near.any()
    assert np.all(nearest(plain.positions[near], changed.positions) < 1e-9)


def test_geometry_knots_and_smooth_joins_are_never_landmarks() -> None:
    seen = sketched(FURNISHED, POSE)
    assert not seen.landmark[seen.kinds == KnotKind.GEOMETRY].any()
    assert (seen.kinds == KnotKind.GEOMETRY).any()


def test_the_polyline_of_all_knots_follows_the_contour() -> None:
    contour = traced(FURNISHED, POSE)
    seen = sketch(contour, SketchSettings())
    outline = LineString(np.vstack([seen.positions, seen.positions[:1]]))
    assert outline.hausdorff_distance(contour.free_space.exterior) < 0.35
    area = contour.free_space.area
    assert abs(np.abs(outline.convex_hull.area) - contour.free_space.convex_hull.area) < 0.02 * area


def test_lines_lie_on_walls_and_face_the_sensor() -> None:
    seen = sketched(L_ROOM, POSE)
    walls = transform(seen.lines.ends.reshape(-1, 2), POSE)
    assert np.max(shapely.distance(L_ROOM.exterior, shapely.points(walls))) < 0.05
    assert np.all(np.sum(seen.lines.normals * (seen.origin - seen.lines.ends[:, 0]), axis=1) > 0)


def test_everything_is_in_the_robots_frame() -> None:
    scan = lidar_scan(L_ROOM, POSE)
    mounted = Sensor("lidar", 30.0, range_noise=0.01, mount=(0.3, -0.2, 0.7))
    plain = sketch(trace(fuse(scan, FusionSettings()), ContourSettings()), SketchSettings())
    moved = sketch(
        trace(fuse(Scan(scan.bearings, scan.ranges, mounted, scan.odometry, 0.0), FusionSettings()), ContourSettings()),
        SketchSettings(),
    )
    assert np.allclose(moved.positions, transform(plain.positions, np.array(mounted.mount)), atol=1e-6)
    assert np.allclose(moved.origin, mounted.mount[:2])


def test_chains_are_runs_of_surface_across_the_wrap_around() -> None:
    real, fake = EdgeKind.REAL, EdgeKind.OCCLUSION
    edges = np.array([real, fake, fake, real, real], dtype=np.uint8)
    assert [chain.tolist() for chain in chains(edges)] == [[3, 4, 0, 1]]
