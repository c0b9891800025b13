"""Claims about poses that stay settled from one look to the next."""

import numpy as np

from backend.settled_poses import SettledPoses
from backend.settling import SettleSettings, settle
from tests.backend.placed_samples import local_samples
from tests.backend.plan_rays import Rays, furnished_plan, misplaced, scattered_poses, view_of

VIEWS = 60
RNG = np.random.default_rng(4)
PLAN = furnished_plan(RNG, 4)
POSES = scattered_poses(PLAN, VIEWS, RNG)
LOCAL = local_samples([view_of(PLAN, pose, Rays(), RNG) for pose in POSES])
PLACED = misplaced(POSES, 0.02, 0.3, RNG)
INDEX = np.arange(VIEWS)


def test_the_first_look_settles_all_views() -> None:
    poses = SettledPoses(SettleSettings()).settled(LOCAL, INDEX, PLACED)
    np.testing.assert_array_equal(poses, settle(LOCAL, PLACED, SettleSettings()))


def test_a_look_at_nothing_new_moves_nothing() -> None:
    looks = SettledPoses(SettleSettings())
    np.testing.assert_array_equal(looks.settled(LOCAL, INDEX, PLACED), looks.settled(LOCAL, INDEX, PLACED))


def test_a_new_view_settles_among_the_others_as_if_all_did() -> None:
    looks = SettledPoses(SettleSettings())
    before = LOCAL.where(LOCAL.view < VIEWS - 1)
    stood = looks.settled(before, INDEX[:-1], PLACED[:-1])
    poses = looks.settled(LOCAL, INDEX, PLACED)
    np.testing.assert_array_equal(poses[:-1], stood)
    assert np.abs(poses - settle(LOCAL, PLACED, SettleSettings()))[:, :2].max() < 0.004


def test_after_many_changes_all_settle_anew() -> None:
    looks = SettledPoses(SettleSettings())
    looks.settled(LOCAL, INDEX, misplaced(POSES, 0.02, 0.3, np.random.default_rng(5)))
    np.testing.assert_array_equal(looks.settled(LOCAL, INDEX, PLACED), settle(LOCAL, PLACED, SettleSettings()))


def test_a_forgotten_view_settles_like_a_new_one() -> None:
    looks = SettledPoses(SettleSettings())
    stood = looks.settled(LOCAL, INDEX, PLACED)
    looks.forget(7)
    moved = looks.settled(LOCAL, INDEX, PLACED) - stood
    assert np.flatnonzero(np.abs(moved).max(axis=1)).tolist() in ([7], [])


def test_a_view_that_moves_twice_is_one_that_changed() -> None:
    looks = SettledPoses(SettleSettings())
    before = looks.settled(LOCAL, INDEX, PLACED)
    moved = PLACED.copy()
    for shift in (0.01, -0.01):
        looks.forget(7)
        moved[7, 0] += shift
        after = looks.settled(LOCAL, INDEX, moved)
    np.testing.assert_array_equal(np.delete(after, 7, axis=0), np.delete(before, 7, axis=0))
