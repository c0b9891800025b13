from typing import Any

import numpy as np
import pytest

from frontend.primitives import Primitive, PrimitiveSettings, classify, smooth_joins
from frontend.scale_space import scale_space
from tests.frontend.test_scale_space import SIGMAS, path

SETTINGS = PrimitiveSettings()
Q = np.pi / 2


@pytest.mark.parametrize(
    ("turns", "places", "expected"),
    [
        ([Q], [1.0], [Primitive.CORNER]),
        ([Q, Q], [1.0, 3.0], [Primitive.CORNER] * 2),
        ([-Q, -Q], [1.0, 1.2], [Primitive.END] * 2),
        ([Q, -Q], [1.0, 1.2], [Primitive.CRANK] * 2),
        ([Q, -Q, -Q, Q], [1.0, 1.2, 2.0, 2.2], [Primitive.BUMP] * 4),
        ([-Q, Q, Q, -Q], [1.0, 1.2, 2.0, 2.2], [Primitive.DENT] * 4),
        ([Q, -Q, -Q, Q], [1.0, 1.2, 4.0, 4.2], [Primitive.CRANK] * 4),
    ],
)
def test_pairs_of_corners_are_named_by_their_signs_and_distance(
    turns: Any, places: list[float], expected: list[int]
) -> None:
    assert classify(np.array(turns), np.array(places), SETTINGS).tolist() == expected


def rounded(radius: float, noise: float = 0.0) -> Any:
    """A straight wall, a quarter of a circle, a straight wall; joins at 3 m and 3 m + πr/2."""
    arc = np.arange(0.02, np.pi / 2, 0.02 / radius)
    before = np.column_stack([np.arange(0, 3.0, 0.02), np.zeros(150)])
    bend = np.column_stack([3.0 + radius * np.sin(arc), radius * (1 - np.cos(arc))])
    after = bend[-1] + np.column_stack([np.zeros(150), np.arange(0.02, 3.02, 0.02)])
    points = np.vstack([before, bend, after])
    return points + np.random.default_rng(0).normal(0, noise, points.shape) if noise else points


@pytest.mark.parametrize("noise", [0.0, 0.003])
def test_straight_meets_curved_at_two_smooth_joins(noise: float) -> None:
    space = scale_space(rounded(0.7, noise), SIGMAS, 0.04)
    joins = smooth_joins(space, np.empty(0), max(noise, 0.001), SETTINGS)
    assert np.allclose(space.arc_length[joins], [3.0, 3.0 + 0.7 * np.pi / 2], atol=0.2)


def test_a_corner_is_no_smooth_join_even_if_nobody_said_it_is_a_corner() -> None:
    space = scale_space(path([(1.0, 3.0)]), SIGMAS, 0.04)
    assert not smooth_joins(space, np.empty(0), 0.001, SETTINGS).size
