"""Undoing the beam: the opened profile of a wide sensor, and the half-beam read off its constant-range arcs.

On rough surfaces a wide beam reports the nearest echo inside it, so the profile over the bearing is the
minimum filter of the true polar profile. Its maximum filter over the same window is the morphological
opening of the truth: exact on walls wider than the beam, short (never long) in corners and narrow gaps.
"""

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Floats, Integers


def undo_beam(bearings: Floats, ranges: Floats, half_beam: float, full_turn: bool) -> Floats:
    """The opened profile (n,): the maximum of `ranges` (n,) within `half_beam` of each bearing (n,).

    Readings that must not spread (no echo, rejected) are nan and stay out of every maximum; where a window
    holds nothing else the profile is nan.
    """
    if half_beam <= 0:
        return ranges.copy()
    first, last = _windows(bearings, half_beam, full_turn)
    return _window_maxima(ranges, first, last)


def _windows(bearings: Floats, half_beam: float, full_turn: bool) -> tuple[Integers, Integers]:
    """First and last index (n,) of the readings within the half-beam, counted past the ends on a full turn."""
    n, turn = bearings.size, 2 * np.pi
    unrolled = np.concatenate([bearings - turn, bearings, bearings + turn]) if full_turn else bearings
    offset = n if full_turn else 0
    slack = 1e-9  # the reading exactly on the beam's edge belongs to it
    first = np.searchsorted(unrolled, bearings - half_beam - slack) - offset
    last = np.searchsorted(unrolled, bearings + half_beam + slack) - 1 - offset
    return first, last


@compiled
def _window_maxima(ranges: Floats, first: Integers, last: Integers) -> Floats:
    n = ranges.size
    maxima = np.full(n, np.nan)
    for i in range(n):
        for j in range(first[i], last[i] + 1):
            value = ranges[j % n]
            if not np.isnan(value) and not maxima[i] >= value:
                maxima[i] = value
    return maxima
