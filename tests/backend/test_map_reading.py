"""Claims about the map as a whole: layers, order, provenance."""

import numpy as np
import shapely

from backend.polygon_merging import merge_views
from backend.room_map import MapEdgeKind
from backend.view import View
from tests.backend.plan_rays import Rays, furnished_plan, misplaced, scattered_poses, view_of


def noisy_case(
    seed: int, count: int
) -> tuple[shapely.Polygon, list[View], np.ndarray[tuple[int, int], np.dtype[np.float64]]]:
    rng = np.random.default_rng(seed)
    plan = furnished_plan(rng, 4)
    poses = scattered_poses(plan, count, rng)
    return plan.free, [view_of(plan, pose, Rays(), rng) for pose in poses], misplaced(poses, 0.03, 0.3, rng)


def test_any_order_of_views_makes_the_same_map() -> None:
    _, views, poses = noisy_case(0, 24)
    order = np.random.default_rng(1).permutation(24)
    one, other = merge_views(views, poses), merge_views([views[i] for i in order], poses[order])
    assert one.free.symmetric_difference(other.free).area < 0.001 * one.free.area


def test_the_safety_layer_keeps_its_distance_everywhere() -> None:
    _, views, poses = noisy_case(2, 24)
    room_map = merge_views(views, poses)
    assert room_map.free.contains(room_map.safety)
    corners = shapely.points(shapely.get_coordinates(room_map.safety))
    assert shapely.distance(corners, room_map.free.boundary).min() > 0.05 - 1e-9


def test_well_seen_walls_are_real_and_supported_by_distinct_views() -> None:
    free, views, poses = noisy_case(3, 24)
    room_map = merge_views(views, poses)
    real = [edge for edge in room_map.edges if edge.kind == MapEdgeKind.REAL]
    length = sum(float(np.hypot(e.end[0] - e.start[0], e.end[1] - e.start[1])) for e in real)
    assert length > 0.95 * free.length
    assert all(edge.support == len(set(edge.views.tolist())) <= 24 for edge in real)
    assert all(edge.support == 0 for edge in room_map.edges if edge.kind == MapEdgeKind.FRONTIER)


def test_somebody_who_stood_in_one_view_leaves_no_trace() -> None:
    free, views, poses = noisy_case(4, 24)
    rng = np.random.default_rng(5)
    spot = poses[0, :2] + 1.0 * np.array([np.cos(poses[0, 2]), np.sin(poses[0, 2])])
    person = shapely.Point(spot).buffer(0.2)
    ring = views[0].boundary
    bearing, reach = np.arctan2(ring[:, 1], ring[:, 0]), np.linalg.norm(ring, axis=1)
    hit = np.abs(bearing) < np.arcsin(0.2)
    shadowed = np.where(hit, np.minimum(reach, 0.85 + rng.normal(0, 0.02, len(reach))), reach)
    ghost = View(
        ring * (shadowed / reach)[:, None], views[0].edges, views[0].spread, views[0].origin, views[0].openings
    )
    room_map = merge_views([ghost, *views[1:]], poses)
    seen_by_others = merge_views(views[1:], poses[1:]).free.intersection(free)
    assert person.intersection(seen_by_others).difference(room_map.free).area < 0.01
