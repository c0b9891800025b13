"""Arcs of headings: intervals that meet at 0 are one arc, and two arcs share what both hold, however they are wound."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.circular import CIRCLE, joined, shared, spoken


def test_the_last_interval_and_the_first_are_one_arc_where_they_meet_at_zero() -> None:
    assert np.allclose(joined(np.array([[0.0, 1.0], [5.0, CIRCLE]])), [[5.0, CIRCLE + 1]])
    apart = np.array([[0.1, 1.0], [5.0, CIRCLE]])
    assert np.array_equal(joined(apart), apart)


def test_two_arcs_may_meet_at_both_ends() -> None:
    both = np.empty((2, 2))
    assert shared(5.0, 7.5, 0.5, 5.5, both) == 2
    assert np.allclose(both, [[5.0, 5.5], [0.5 + CIRCLE, 7.5]])


def arc() -> st.SearchStrategy[tuple[float, float]]:
    return st.tuples(st.floats(0, 6.28), st.floats(0.01, CIRCLE)).map(lambda one: (one[0], one[0] + one[1]))


def within(heading: float, low: float, high: float) -> bool:
    return bool((heading - low) % CIRCLE < high - low)


@settings(deadline=None, max_examples=100)
@given(arc(), arc(), st.floats(0, CIRCLE))
def test_a_heading_is_shared_when_both_arcs_hold_it(
    first: tuple[float, float], second: tuple[float, float], heading: float
) -> None:
    found = np.empty((2, 2))
    count = shared(*first, *second, found)
    ends = np.array([*first, *second])
    if np.min(np.abs((ends - heading + np.pi) % CIRCLE - np.pi)) > 1e-6:
        both = within(heading, *first) and within(heading, *second)
        assert any(within(heading, *map(float, row)) for row in found[:count]) == both


def test_arcs_are_spoken_of_in_whole_degrees_of_one_turn() -> None:
    assert spoken(0.1, 1.0) == "6° to 57°"
    assert spoken(6.0, CIRCLE + 0.5) == "344° to 29°"
    assert spoken(-0.3, 0.3) == "343° to 17°"
    assert spoken(3 * CIRCLE + 1.0, 4 * CIRCLE) == "57° to 360°"
    assert spoken(6.2829, CIRCLE + 1.0) == "0° to 57°"
    assert spoken(0.0, CIRCLE) == "0° to 360°"
