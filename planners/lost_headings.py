"""Why no way along the spines was found: the slice nearest the goal that the robot could not pass, and what it lost."""

import numpy as np
from numpy.typing import NDArray

from planners.circular import joined, spoken
from planners.orientations import intersected
from planners.slices import Slices
from planners.spine_graph import SpineGraph

Floats = NDArray[np.float64]


def why_not(slices: Slices, graph: SpineGraph, closed: NDArray[np.bool_], goal: Floats) -> str:
    """One sentence. closed: (n,) the nodes that were reached, at least one; goal: (3,)."""
    reached = np.unique(graph.node_stop[closed])
    cones = np.unique(graph.stops[reached, 0].astype(int))
    ends = np.concatenate([slices.first[cones], slices.first[cones + 1] - 1])
    middles = (slices.pieces[:, :2] + slices.pieces[:, 2:]) / 2
    last = int(ends[np.argmin(np.linalg.norm(middles[ends] - goal[:2], axis=1))])
    cone = int(np.searchsorted(slices.first, last, side="right") - 1)
    stops = reached[graph.stops[reached, 0] == cone]
    near = stops[np.argmin(np.abs(graph.stops[stops, 2] - last))]
    return _at_slice(slices, int(graph.stops[near, 2]), last)


def _at_slice(slices: Slices, row: int, last: int) -> str:
    """Follow a spine from a slice that was reached to its end, to the first slice that keeps none of the headings."""
    legal, step = slices.legal[row, : slices.counts[row]], 1 if last > row else -1
    for each in range(row, last + step, step):
        kept = intersected(legal, slices.legal[each, : slices.counts[each]])
        if not len(kept):
            x, y = slices.pieces[each, :2]
            return f"the slice at ({x:.2f}, {y:.2f}) loses the headings {_degrees(legal)} that lead there"
        legal = kept
    x, y = slices.pieces[last, 2:] if step > 0 else slices.pieces[last, :2]
    return f"the spine that comes nearest ends at ({x:.2f}, {y:.2f}), where the headings {_degrees(legal)} are lost"


def _degrees(legal: Floats) -> str:
    return ", ".join(spoken(low, high) for low, high in joined(legal))
