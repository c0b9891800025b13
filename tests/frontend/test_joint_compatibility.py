from itertools import product
from typing import Any

import numpy as np
import pytest
from scipy.stats import chi2

from frontend.joint_compatibility import JointPairs, most_joint_pairs
from frontend.rigid_motion import rotation, transform

DOUBT = np.diag([0.3, 0.3, 0.1]) ** 2
GUESS = np.array([0.5, 0.1, 0.2])


def knots(seed: int, count: int = 4, strangers: int = 1) -> Any:
    rng = np.random.default_rng(seed)
    truth = GUESS + rng.multivariate_normal(np.zeros(3), 0.25 * DOUBT)
    moving = rng.uniform(-3, 3, (count, 2))
    fixed = np.vstack([transform(moving, truth), rng.uniform(-3, 3, (strangers, 2))]) + rng.normal(
        0, 0.02, (count + strangers, 2)
    )
    spread = 0.02**2 * np.eye(2)
    alike = np.ones((count + strangers, count), dtype=bool)
    return JointPairs(fixed, np.tile(spread, (count + strangers, 1, 1)), moving, np.tile(spread, (count, 1, 1)), alike)


def joint_distance(given: Any, pairs: Any) -> Any:
    """The distance with the full joint innovation covariance, written out."""
    turn, placed = rotation(GUESS[2]), transform(given.moving, GUESS)
    off = np.concatenate([given.fixed[a] - placed[b] for a, b in pairs])
    slopes = np.vstack(
        [np.column_stack([np.eye(2), [[-(placed[b] - GUESS[:2])[1]], [(placed[b] - GUESS[:2])[0]]]]) for _, b in pairs]
    )
    spread = slopes @ DOUBT @ slopes.T
    for k, (a, b) in enumerate(pairs):
        spread[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] += (
            given.fixed_covariances[a] + turn @ given.moving_covariances[b] @ turn.T
        )
    return off @ np.linalg.solve(spread, off)


@pytest.mark.parametrize("seed", range(6))
def test_no_larger_jointly_compatible_set_exists(seed: int) -> None:
    given = knots(seed)
    found = most_joint_pairs(given, GUESS, DOUBT, 0.99)
    compatible = []
    for choice in product(range(-1, 5), repeat=4):
        pairs = [(a, b) for b, a in enumerate(choice) if a >= 0]
        if pairs and len({a for a, _ in pairs}) == len(pairs):
            distance = joint_distance(given, pairs)
            if distance <= chi2.ppf(0.99, 2 * len(pairs)):
                compatible.append((-len(pairs), distance))
    most, least = min(compatible)
    assert len(found) == -most
    assert np.isclose(joint_distance(given, [tuple(pair) for pair in found]), least)


def test_pairs_that_fit_alone_but_not_together_are_not_taken_together() -> None:
    given = knots(1, count=2, strangers=0)
    pulled = given.fixed + np.array([[0.4, 0.0], [-0.4, 0.0]])
    apart = JointPairs(pulled, given.fixed_covariances, given.moving, given.moving_covariances, np.eye(2, dtype=bool))
    assert len(most_joint_pairs(apart, GUESS, DOUBT, 0.99)) < 2


def test_unlike_knots_never_pair() -> None:
    given = knots(2)
    none = JointPairs(
        given.fixed, given.fixed_covariances, given.moving, given.moving_covariances, np.zeros_like(given.alike)
    )
    assert most_joint_pairs(none, GUESS, DOUBT, 0.99).shape == (0, 2)
