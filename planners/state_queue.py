"""A priority queue of states for the compiled searches: a binary heap in which a state can move forward."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.compiled import kernel

Ints = NDArray[np.int32]


class Queue(NamedTuple):
    """heap (s,) of states; place (s,) of each state in it; key (s,) by which they leave; size (1,).

    A place is only believed if the heap holds the state there, so emptying the queue means setting its size to 0.
    """

    heap: Ints
    place: Ints
    key: NDArray[np.float64]
    size: NDArray[np.int64]


def queue_for(states: int) -> Queue:
    """An empty queue for states 0 … states − 1."""
    place = np.zeros(states, dtype=np.int32)
    return Queue(np.zeros(states, dtype=np.int32), place, np.empty(states), np.zeros(1, dtype=np.int64))


@kernel
def push(queue: Queue, state: int, key: float) -> None:
    """Add a state, or move it forward if it waits with a greater key."""
    hole = queue.place[state]
    if hole >= queue.size[0] or queue.heap[hole] != state:
        hole = queue.size[0]
        queue.size[0] += 1
    elif key >= queue.key[state]:
        return
    while hole > 0 and queue.key[queue.heap[(hole - 1) // 2]] > key:
        queue.heap[hole] = queue.heap[(hole - 1) // 2]
        queue.place[queue.heap[hole]] = hole
        hole = (hole - 1) // 2
    queue.heap[hole], queue.place[state], queue.key[state] = state, hole, key


@kernel
def pop(queue: Queue) -> int:
    """Remove the state with the least key."""
    first, last = queue.heap[0], queue.heap[queue.size[0] - 1]
    queue.size[0] -= 1
    size, hole = queue.size[0], 0
    while 2 * hole + 1 < size:
        child = 2 * hole + 1
        if child + 1 < size and queue.key[queue.heap[child + 1]] < queue.key[queue.heap[child]]:
            child += 1
        if queue.key[queue.heap[child]] >= queue.key[last]:
            break
        queue.heap[hole] = queue.heap[child]
        queue.place[queue.heap[hole]] = hole
        hole = child
    queue.heap[hole], queue.place[last] = last, hole
    return int(first)
