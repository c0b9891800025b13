"""Claims about where to look next."""

import numpy as np

from backend.next_view import NextViewSettings, next_view
from backend.polygon_merging import merge_views
from tests.backend.plan_rays import Rays, empty_room, furnished_plan, view_of


def test_the_unseen_part_of_a_room_is_where_to_look() -> None:
    rng = np.random.default_rng(0)
    pose = np.array([1.0, 2.0, np.pi])
    rays = Rays(beams=180, field=np.pi)
    room_map = merge_views([view_of(empty_room(), pose, rays, rng)], pose[None])
    best = next_view(room_map, pose, 8.0, NextViewSettings())
    assert best is not None
    assert best.gain > 2.5
    assert abs(best.pose[2]) < 0.3
    np.testing.assert_allclose(best.frontier[:, 0], 1.0, atol=0.1)


def test_a_finished_room_needs_no_further_look() -> None:
    rng = np.random.default_rng(1)
    poses = np.array([[1.0, 1.0, 0.0], [5.0, 3.0, 0.0]])
    room_map = merge_views([view_of(empty_room(), pose, Rays(), rng) for pose in poses], poses)
    assert next_view(room_map, poses[0], 8.0, NextViewSettings()) is None


def test_the_next_place_is_safe_and_sees_its_frontier() -> None:
    rng = np.random.default_rng(2)
    plan = furnished_plan(rng, 4, obstacles=0)
    pose = np.array([*plan.free.representative_point().coords[0], 0.0])
    room_map = merge_views([view_of(plan, pose, Rays(), rng)], pose[None])
    best = next_view(room_map, pose, 6.0, NextViewSettings())
    assert best is not None
    assert room_map.safety.contains(plan.free.representative_point())
    assert np.linalg.norm(best.frontier - best.pose[:2], axis=1).max() <= 6.0
