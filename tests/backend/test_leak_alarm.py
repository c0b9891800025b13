"""Claims about the wall-leak alarm and the reasons it gives."""

import numpy as np
from numpy.typing import NDArray
from shapely import MultiPolygon, box

from backend.leak_alarm import alarms, why
from backend.leak_repair import supported_bins
from backend.samples import Samples
from backend.seen_through import Beams, beams_of, seen_through
from backend.sight import sight_of
from backend.view import View, place
from backend.wall_faces import FaceSettings, fuse_faces
from tests.backend.placed_samples import beams_to, local_samples, wall_samples
from tests.backend.plan_rays import Plan, Rays, view_of

FREE = MultiPolygon([box(-1, -1, 3, 2)])
RING = np.array([[-1.0, -1.0], [3.0, -1.0], [3.0, 2.0], [-1.0, 2.0]])


def test_the_alarm_names_who_measured_a_leaking_face_and_who_saw_through() -> None:
    samples = wall_samples(np.array([0.0, 0.0]), np.array([2.0, 0.0]), 3, 0.002, np.random.default_rng(0))
    bins = supported_bins(samples, fuse_faces(samples, FaceSettings()))
    beams = beams_to([RING] * 5, np.tile([1.0, 1.0], (5, 1)))
    middles, views = alarms(FREE, bins, samples, beams, 0.05)
    assert len(middles) == len(views) == len(bins.support)
    for measured, through in views:
        assert measured.tolist() == [0, 1, 2]
        assert through.tolist() == [3, 4]


def test_the_order_of_the_views_says_what_moved() -> None:
    early, late, middle = np.array([1, 2, 3]), np.array([7, 8]), np.array([4, 5])
    assert "gone from view 7 on" in why(early, late)
    assert "came after view 3" in why(late, early)
    assert "only from view 4 to view 5" in why(middle, np.array([1, 8]))
    assert "1 of them in between: glass" in why(np.array([1, 9]), np.array([5]))
    assert "too short a piece" in why(early, np.empty(0, dtype=np.int64))


def test_a_corridor_drawn_twice_is_loud() -> None:
    rng, plan = np.random.default_rng(4), Plan(box(0, 0, 12, 2), np.empty((0, 2, 2)), ())
    there = np.array([[x, 1.0, 0.0] for x in range(1, 11)])
    views = [view_of(plan, pose, Rays(), rng) for pose in [*there, *there]]
    aside = np.vstack([there, there + np.array([0.0, 0.15, 0.0])])
    beams, samples = _placed(views, aside)
    bins = supported_bins(samples, fuse_faces(samples, FaceSettings()))
    drawn_wide = MultiPolygon([box(0, 0, 12, 2.15)])
    assert len(alarms(drawn_wide, bins, samples, beams, 0.05)[0]) > 100
    overruled = bins.where(np.abs(bins.middles[:, 1] - 2) < 0.05)
    assert np.median(seen_through(overruled, beams, 0.05)) >= 5


def _placed(views: list[View], poses: NDArray[np.float64]) -> tuple[Beams, Samples]:
    """The beams and the samples of views at poses (v, 3)."""
    rings = [place(view.boundary, pose) for view, pose in zip(views, poses, strict=True)]
    return beams_of(sight_of(rings, poses[:, :2]), rings), local_samples(views).placed(poses)
