"""The queue of states: whatever waits leaves by its least key, and an emptied queue remembers nothing."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from planners.compiled import compiled
from planners.state_queue import Queue, pop, push, queue_for


@compiled
def left(queue: Queue, states: NDArray[np.int64], keys: NDArray[np.float64]) -> NDArray[np.int64]:
    """The states in the order they leave, after all were added with their keys, one by one."""
    for k in range(states.size):
        push(queue, states[k], keys[k])
    order = np.empty(queue.size[0], np.int64)
    for k in range(order.size):
        order[k] = pop(queue)
    return order


@settings(deadline=None, max_examples=60)
@given(st.lists(st.tuples(st.integers(0, 15), st.floats(0, 100)), max_size=60))
def test_each_state_leaves_once_by_the_least_key_it_was_given(added: list[tuple[int, float]]) -> None:
    best: dict[int, float] = {}
    for state, key in added:
        best[state] = min(key, best.get(state, key))
    states = np.array([state for state, _ in added], np.int64)
    order = left(queue_for(16), states, np.array([key for _, key in added]))
    assert sorted(order) == sorted(best)
    assert [best[state] for state in order] == sorted(best.values())


def test_a_queue_that_was_emptied_by_its_size_takes_the_same_states_again() -> None:
    queue, states = queue_for(4), np.arange(4)
    push_only = np.array([3.0, 2.0, 1.0, 0.0])
    left(queue, states, push_only)
    queue.size[0] = 0
    assert left(queue, states, push_only[::-1].copy()).tolist() == [0, 1, 2, 3]
