"""Claims of the merge on plans whose truth is known."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from backend.polygon_merging import Merger, MergingError, merge_views
from tests.backend.plan_rays import Rays, empty_room, furnished_plan, misplaced, scattered_poses, seen_from, view_of


def test_an_empty_room_comes_back_whole() -> None:
    rng = np.random.default_rng(0)
    plan = empty_room()
    poses = scattered_poses(plan, 8, rng)
    room_map = merge_views([view_of(plan, pose, Rays(), rng) for pose in poses], poses)
    assert room_map.free.symmetric_difference(plan.free).area < 0.01 * plan.free.area


def test_misplaced_views_still_make_a_map_close_to_what_was_seen() -> None:
    rng = np.random.default_rng(3)
    plan = furnished_plan(rng, 3)
    poses = scattered_poses(plan, 20, rng)
    views = [view_of(plan, pose, Rays(), rng) for pose in poses]
    free = merge_views(views, misplaced(poses, 0.02, 0.3, rng)).free
    seen = seen_from(plan, poses, 10.0)
    assert free.intersection(seen).area / free.union(seen).area > 0.97


def test_a_view_moved_away_and_back_leaves_no_trace() -> None:
    rng = np.random.default_rng(4)
    plan = empty_room()
    poses = scattered_poses(plan, 4, rng)
    merger = Merger()
    for index, pose in enumerate(poses):
        merger.add(view_of(plan, pose, Rays(beams=180), rng), pose, index)
    before = merger.result().free
    merger.move(2, poses[2] + [0.5, -0.3, 0.2])
    assert not shapely.equals_exact(merger.result().free, before, 1e-9)
    merger.move(2, poses[2])
    assert shapely.equals_exact(merger.result().free, before, 1e-9)


def test_a_view_is_added_only_once_and_moved_only_after_that() -> None:
    rng = np.random.default_rng(5)
    plan = empty_room()
    view = view_of(plan, np.array([1.0, 1.0, 0.0]), Rays(beams=90), rng)
    merger = Merger()
    with pytest.raises(MergingError, match="view 3 cannot move"):
        merger.move(3, np.zeros(3))
    merger.add(view, np.zeros(3), 3)
    with pytest.raises(MergingError, match="view 3 is in the map already"):
        merger.add(view, np.zeros(3), 3)


def test_a_surface_less_sure_than_the_strip_is_thick_votes_for_no_wall() -> None:
    rng = np.random.default_rng(6)
    plan = empty_room()
    sure = view_of(plan, np.array([1.0, 1.0, 0.0]), Rays(), rng)
    vague = replace(sure, spread=np.full_like(sure.spread, 0.2), boundary=0.9 * sure.boundary)
    pose = np.array([1.0, 1.0, 0.0])
    room_map = merge_views([sure, vague, vague], np.array([pose, pose, pose]))
    assert room_map.free.symmetric_difference(plan.free).area < 0.02 * plan.free.area


def test_a_map_that_follows_its_views_is_the_map_of_these_views() -> None:
    rng = np.random.default_rng(8)
    plan = furnished_plan(rng, 3)
    poses = scattered_poses(plan, 20, rng)
    views = [view_of(plan, pose, Rays(), rng) for pose in poses]
    merger = Merger()
    merger.follow(views[:15] + views[:2], np.concatenate([poses[:15], poses[:2]]))
    merger.result()
    merger.follow(views, poses)
    grown, fresh = merger.result().free, merge_views(views, poses).free
    assert grown.symmetric_difference(fresh).area < 1e-3 * fresh.area
    merger.follow(views[:12], poses[:12])
    assert {int(view) for edge in merger.result().edges for view in edge.views} <= set(range(12))


def test_a_view_that_is_not_in_the_map_cannot_be_removed() -> None:
    with pytest.raises(MergingError, match="never added"):
        Merger().remove(3)


def test_views_without_poses_are_refused_before_anything_changed() -> None:
    merger = Merger()
    view = view_of(empty_room(), np.array([3.0, 2.0, 0.0]), Rays(), np.random.default_rng(0))
    with pytest.raises(MergingError, match="2 views cannot stand at 1 poses"):
        merger.follow([view, view], np.zeros((1, 3)))
    with pytest.raises(MergingError, match="one view at least"):
        merger.result()
