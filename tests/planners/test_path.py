"""Paths: the way of the reference point and the turning are sums over the pieces, whichever way round."""

import numpy as np
import pytest

from planners.path import Path

THERE = Path(np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 1.0], [3.0, 4.0, -1.0], [3.0, 5.0, -1.0]]), 0.1, "")


def test_length_counts_the_way_and_turning_the_turns() -> None:
    assert THERE.length == pytest.approx(6)
    assert THERE.turning == pytest.approx(3)


def test_the_way_back_is_as_long() -> None:
    back = Path(THERE.poses[::-1], 0.1, "")
    assert (back.length, back.turning) == pytest.approx((THERE.length, THERE.turning))
