"""Claims about walls that the votes opened."""

import numpy as np
from shapely import MultiPolygon, box

from backend.leak_repair import leaking, repaired, standing, supported_bins
from backend.polygon_merging import merge_views
from backend.seen_through import seen_through
from backend.wall_faces import FaceSettings, fuse_faces
from tests.backend.placed_samples import beams_to, wall_samples
from tests.backend.plan_rays import Plan, Rays, view_of

FACE = (np.array([0.0, 0.0]), np.array([2.0, 0.0]))
NEAR_ROOM = np.array([[-1.0, 0.0], [3.0, 0.0], [3.0, 2.0], [-1.0, 2.0]])
THROUGH = NEAR_ROOM - [0.0, 1.0]


def test_a_face_stands_unless_more_views_saw_through_it_from_the_front() -> None:
    samples = wall_samples(*FACE, 3, 0.002, np.random.default_rng(0))
    bins = supported_bins(samples, fuse_faces(samples, FaceSettings()))
    assert set(bins.support) == {3}
    front, behind = np.array([1.0, 0.8]), np.array([1.0, -0.5])
    through_twice = beams_to([THROUGH] * 2, np.array([front, front]))
    through_often = beams_to([THROUGH] * 5, np.tile(front, (5, 1)))
    from_behind = beams_to([THROUGH] * 5, np.tile(behind, (5, 1)))
    assert standing(bins, seen_through(bins, through_twice, 0.05)).all()
    assert not standing(bins, seen_through(bins, through_often, 0.05)).any()
    assert standing(bins, seen_through(bins, from_behind, 0.05)).all()


def test_faces_leak_inside_free_ground_only() -> None:
    samples = wall_samples(*FACE, 3, 0.002, np.random.default_rng(1))
    bins = supported_bins(samples, fuse_faces(samples, FaceSettings()))
    assert len(leaking(MultiPolygon([box(-1, 0, 3, 2)]), bins, 0.05).support) == 0
    assert len(leaking(MultiPolygon([box(-1, -1, 3, 2)]), bins, 0.05).support) == len(bins.support)


def test_a_face_inside_free_ground_gets_a_strip_behind_it_and_no_other() -> None:
    samples = wall_samples(*FACE, 3, 0.002, np.random.default_rng(1))
    bins = supported_bins(samples, fuse_faces(samples, FaceSettings()))
    mended = repaired(MultiPolygon([box(-1, -1, 3, 2)]), bins, 0.05)
    assert box(-1, -1, 3, 2).difference(mended).symmetric_difference(box(0, -0.05, 1.95, 0)).area < 0.02
    untouched = MultiPolygon([box(-1, 0, 3, 2)])
    assert repaired(untouched, bins, 0.05).equals(untouched)


def test_a_panel_thinner_than_the_strip_survives_many_views_from_both_sides() -> None:
    rng = np.random.default_rng(2)
    plan = Plan(box(0, 0, 6, 4).difference(box(2.985, 0, 3.015, 2.5)), np.empty((0, 2, 2)), ())  # type: ignore[arg-type]
    left = [np.array([x, y, 0.0]) for x in (1.0, 2.0) for y in (0.8, 1.5, 2.0)]
    right = [np.array([x, y, 0.0]) for x in (4.0, 5.0) for y in (0.7, 1.3, 1.9)]
    poses = np.array([*left, *right])
    room_map = merge_views([view_of(plan, pose, Rays(noise=0.01), rng) for pose in poses], poses)
    crossing = box(2.9, 1.0, 3.1, 1.001)
    assert not room_map.free.covers(crossing)
    assert len(room_map.leaks) == 0
