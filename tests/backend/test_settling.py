"""Claims about views that settle on the walls they share."""

import numpy as np
from numpy.typing import NDArray

from backend.settling import SettleSettings, settle
from tests.backend.placed_samples import local_samples
from tests.backend.plan_rays import Rays, furnished_plan, misplaced, scattered_poses, view_of

Floats = NDArray[np.float64]


def relative_error(poses: Floats, truth: Floats) -> float:
    """Root mean square distance of positions after the best rigid alignment, metres."""
    one, other = poses[:, :2] - poses[:, :2].mean(axis=0), truth[:, :2] - truth[:, :2].mean(axis=0)
    turn = np.arctan2(np.sum(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]), np.sum(one * other))
    cosine, sine = np.cos(turn), np.sin(turn)
    aligned = one @ np.array([[cosine, sine], [-sine, cosine]])
    return float(np.sqrt(np.mean(np.sum((aligned - other) ** 2, axis=1))))


def test_views_five_centimetres_off_settle_to_one() -> None:
    rng = np.random.default_rng(0)
    plan = furnished_plan(rng, 4)
    poses = scattered_poses(plan, 40, rng)
    local = local_samples([view_of(plan, pose, Rays(), rng) for pose in poses])
    placed = misplaced(poses, 0.05, 0.5, rng)
    settled = settle(local, placed, SettleSettings())
    assert relative_error(placed, poses) > 0.05
    assert relative_error(settled, poses) < 0.012


def test_true_poses_stay_where_they_are() -> None:
    rng = np.random.default_rng(1)
    plan = furnished_plan(rng, 4)
    poses = scattered_poses(plan, 30, rng)
    local = local_samples([view_of(plan, pose, Rays(), rng) for pose in poses])
    settled = settle(local, poses, SettleSettings())
    assert np.abs(settled - poses)[:, :2].max() < 0.02


def test_a_lone_view_stays_where_it_was_put() -> None:
    rng = np.random.default_rng(2)
    plan = furnished_plan(rng, 3)
    pose = scattered_poses(plan, 1, rng)
    local = local_samples([view_of(plan, pose[0], Rays(), rng)])
    np.testing.assert_allclose(settle(local, pose, SettleSettings()), pose, atol=1e-12)
