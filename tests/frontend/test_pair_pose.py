from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from frontend.pair_pose import PairedKnots, pose_of_pairs
from frontend.rigid_motion import between, transform
from frontend.scan import Floats

poses = st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-3, 3)).map(np.array)


def pairs(pose: Floats, count: int, noise: float = 0.0, turns: Any = False, seed: int = 0) -> Any:
    rng = np.random.default_rng(seed)
    moving = rng.uniform(-4, 4, (count, 2))
    fixed = transform(moving, pose) + rng.normal(0, max(noise, 1e-12), (count, 2))
    spread = np.tile(0.5 * max(noise, 0.01) ** 2 * np.eye(2), (count, 1, 1))
    return PairedKnots(fixed, spread, moving, spread, np.full(count, pose[2] if turns else np.nan))


@settings(deadline=None, max_examples=30)
@given(poses, st.integers(2, 8))
def test_clean_pairs_give_back_the_pose(pose: Floats, count: int) -> None:
    found, _, residual = pose_of_pairs(pairs(pose, count), None, 0.07)
    assert np.allclose(between(pose, found), 0.0, atol=1e-5)
    assert residual < 1e-5


@settings(deadline=None, max_examples=10)
@given(poses)
def test_one_pair_with_a_direction_is_a_pose(pose: Floats) -> None:
    found, information, _ = pose_of_pairs(pairs(pose, 1, turns=True), None, 0.07)
    assert np.allclose(between(pose, found), 0.0, atol=1e-6)
    assert np.linalg.matrix_rank(information) == 3


def test_the_information_is_that_of_many_noisy_pairs() -> None:
    pose, errors = np.array([1.0, -2.0, 0.5]), []
    for seed in range(200):
        found, information, _ = pose_of_pairs(pairs(pose, 5, 0.05, seed=seed), None, 0.07)
        off = found - pose
        errors.append(off @ information @ off)
    assert 2.2 < np.mean(errors) < 4.0
