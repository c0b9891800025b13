"""Claims about where a surface ends between two beams."""

import numpy as np

from backend.half_steps import by_half_steps
from backend.polygon_merging import merge_views
from backend.view import EdgeKind, View, WideBeam
from tests.backend.plan_rays import Rays, furnished_plan, scattered_poses, view_of

RING = np.array([[2.0, -1.0], [2.0, 1.0], [4.0, 2.4], [-1.0, 1.0], [-1.0, -1.0]])
KINDS = np.array([EdgeKind.REAL, EdgeKind.OCCLUSION, EdgeKind.REAL, EdgeKind.REAL, EdgeKind.REAL], dtype=np.uint8)


def test_a_jump_in_depth_stands_halfway_between_its_two_beams() -> None:
    stepped = by_half_steps(View(RING, KINDS, np.full(5, 0.02), np.zeros(2), np.empty((0, 2, 2))))
    bearings, ranges = np.arctan2(*stepped.boundary.T[::-1]), np.hypot(*stepped.boundary.T)
    np.testing.assert_allclose(bearings[2:4], 0.5 * (bearings[1] + bearings[4]))
    np.testing.assert_allclose(ranges[2:4], ranges[[1, 4]])
    assert stepped.edges.tolist() == [0, 1, 1, 1, 0, 0, 0]
    np.testing.assert_array_equal(np.delete(stepped.boundary, [2, 3], axis=0), RING)


def test_a_wide_beam_keeps_its_chords() -> None:
    wide = WideBeam(np.full(5, np.inf), np.zeros(5))
    view = View(RING, KINDS, np.full(5, 0.02), np.zeros(2), np.empty((0, 2, 2)), wide)
    assert by_half_steps(view) is view


def test_ends_of_walls_keep_their_length_on_the_mean() -> None:
    rng = np.random.default_rng(3)
    plan = furnished_plan(rng, 8, 0)
    poses = scattered_poses(plan, 25, rng)
    room_map = merge_views([view_of(plan, pose, Rays(beams=240), rng) for pose in poses], poses)
    lost = plan.free.symmetric_difference(room_map.free).intersection(plan.free.boundary.buffer(0.3))
    eaten, left = lost.difference(plan.free).area, lost.intersection(plan.free).area
    assert abs(eaten - left) < 0.5 * (eaten + left)
