"""Laws of the paper's planner input."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import MultiPolygon, box

from backend.contours import as_polygons
from backend.thin_rectangles import SIDE, WIDTH, ThinRectangleError, free_space, thin_rectangles
from tests.backend.plan_rays import furnished_plan


@given(st.integers(0, 1000), st.integers(3, 8))
@settings(deadline=None, max_examples=12)
def test_a_plan_comes_back_from_its_rectangles(seed: int, rooms: int) -> None:
    free = MultiPolygon([furnished_plan(np.random.default_rng(seed), rooms).free])
    back = free_space(thin_rectangles(free))
    assert back.symmetric_difference(free).area < 1e-6


def test_rectangles_are_one_wide_linked_and_on_the_map() -> None:
    rectangles = thin_rectangles(as_polygons(box(0, 0, 6, 4).difference(box(2, 1, 3, 2))))
    assert [len(chain) for chain in rectangles.chains] == [4, 4]
    for chain in rectangles.chains:
        np.testing.assert_allclose(np.linalg.norm(chain[:, 3] - chain[:, 0], axis=1), WIDTH)
        assert chain.min() > 0
        assert chain.max() < SIDE


def test_a_broken_chain_is_refused_with_its_gap() -> None:
    rectangles = thin_rectangles(MultiPolygon([box(0, 0, 6, 4)]))
    broken = rectangles.chains[0].copy()
    broken[2] += 0.5
    with pytest.raises(ThinRectangleError, match=r"chain 0: rectangle 1 ends 0\.707 units"):
        free_space(replace(rectangles, chains=(broken,)))
