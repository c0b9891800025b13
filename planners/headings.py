"""Headings along a path for the least turning in all, given the arcs that are legal on every piece of it."""

from collections.abc import Sequence
from math import inf, isfinite

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Arc = tuple[float, float]

CIRCLE = 2 * np.pi


def least_turning(legs: Sequence[Arc], turns: Sequence[Arc]) -> Floats:
    """One heading per leg, unwrapped, with the least sum of turns.

    legs: (k) arcs of headings to choose from; turns: (k − 1) arcs that contain the legs before and after and in which
    the robot turns from one to the next. Arcs as in `planners.circular`.
    """
    lifted = _lifted(legs, turns)
    headings = np.empty(len(lifted))
    begin, (low, high) = 0, lifted[0]
    for k, (least, most) in enumerate(lifted[1:], start=1):
        if max(low, least) <= min(high, most):
            low, high = max(low, least), min(high, most)
            continue
        # No heading serves this leg too: settle those so far at the near end, go on from the next one's near end.
        headings[begin:k] = high if least > high else low
        low = high = least if least > high else most
        begin = k
    headings[begin:] = _within(low, high)
    return headings


def _within(low: float, high: float) -> float:
    """A heading between two limits, of which none, one or both may be infinite."""
    if isfinite(low) and isfinite(high):
        return (low + high) / 2
    return low if isfinite(low) else high if isfinite(high) else 0.0


def _lifted(legs: Sequence[Arc], turns: Sequence[Arc]) -> list[Arc]:
    """The legs unwrapped, so that successive ones lie in the turn between them; a full circle has no limits."""
    lifted, here = [_open(legs[0])], _open(legs[0])
    for leg, turn in zip(legs[1:], turns, strict=True):
        middle = _within(*here)
        if turn[1] - turn[0] >= CIRCLE:
            shift = 0.0 if leg[1] - leg[0] >= CIRCLE else CIRCLE * round((middle - sum(leg) / 2) / CIRCLE)
        else:
            around = CIRCLE * round((middle - sum(turn) / 2) / CIRCLE)
            shift = around + CIRCLE * round((sum(turn) / 2 - sum(leg) / 2) / CIRCLE)
        low, high = _open(leg)
        low, high = low + shift, high + shift
        lifted.append((low, high))
        common = max(here[0], low), min(here[1], high)
        here = common if common[0] <= common[1] else ((low, low) if low > here[1] else (high, high))
    return lifted


def _open(arc: Arc) -> Arc:
    return (-inf, inf) if arc[1] - arc[0] >= CIRCLE else arc
