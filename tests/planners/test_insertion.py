"""Sorting for compiled loops: the order numpy gives, equals as they came."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from planners.compiled import compiled
from planners.insertion import order_of


@compiled
def ordered(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """From Python, which the kernel itself is not called from."""
    return order_of(values)


@settings(deadline=None, max_examples=60)
@given(st.lists(st.integers(-3, 3), max_size=20))
def test_it_sorts_as_numpy_does_and_leaves_equals_in_their_order(values: list[int]) -> None:
    given_values = np.array(values, float)
    assert np.array_equal(ordered(given_values), np.argsort(given_values, kind="stable"))
