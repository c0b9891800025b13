"""Arcs of headings that may reach across 0: rows (k, 2) with low in [0, 2π) and high up to low + 2π."""

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled

Floats = NDArray[np.float64]

CIRCLE = 2 * np.pi


def spoken(low: float, high: float) -> str:
    """An arc of headings in words: whole degrees from 0 to 360, the end before the begin where it reaches across 0."""
    begin, end = round(np.degrees(low)), round(np.degrees(high))
    turns = begin // 360
    end -= 360 * turns
    return f"{begin - 360 * turns}° to {end - 360 if end > 360 else end}°"


@compiled
def joined(cut: Floats) -> Floats:
    """Arcs from a set of intervals in [0, 2π]: the last and the first become one where they meet at 0."""
    total = cut.shape[0]
    arcs = cut.copy()
    if total > 1 and cut[0, 0] == 0.0 and cut[total - 1, 1] == CIRCLE:
        arcs[0, 0], arcs[0, 1] = cut[total - 1, 0], cut[0, 1] + CIRCLE
        arcs = arcs[: total - 1].copy()
    return arcs


@compiled
def shared(first_low: float, first_high: float, second_low: float, second_high: float, arcs: Floats) -> int:
    """Write the arcs common to two arcs into `arcs` (≥ 2, 2), inside the first; returns how many."""
    if second_high - second_low >= CIRCLE:
        arcs[0, 0], arcs[0, 1] = first_low, first_high
        return 1
    if first_high - first_low >= CIRCLE:
        arcs[0, 0], arcs[0, 1] = second_low, second_high
        return 1
    count = 0
    for turn in range(-1, 2):
        low = max(first_low, second_low + turn * CIRCLE)
        high = min(first_high, second_high + turn * CIRCLE)
        if low < high and count < 2:
            arcs[count, 0], arcs[count, 1] = low, high
            count += 1
    return count
