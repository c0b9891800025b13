"""Undoing the beam: the opened profile of a wide sensor.

On rough surfaces a wide beam reports the nearest echo inside it, so the profile over the bearing is a minimum filter of
the true polar profile, and its opening is what surely is free: exact on walls wider than the beam, short (never long)
in corners and narrow gaps. A near surface is heard farther off the axis than a far one, so the beam narrows with the
range: a reading says that nothing lies nearer than it, at each angle off its axis as far as surfaces are heard there.
"""

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Floats, Integers


def undo_beam(bearings: Floats, ranges: Floats, beam: Floats, full_turn: bool) -> Floats:
    """The opened profile (n,) of `ranges` (n,) at `bearings` (n,): the farthest that any reading vouches for.

    beam: (k, 2) rows of metres and radians, the half-beam narrowing from row to row. A reading vouches for its own
    range on its axis, and off it for no more than the range at which the half-beam has narrowed to that angle.
    Readings that must not spread (no echo, rejected) are nan and vouch for nothing; nan where nobody vouches.
    """
    widest = float(beam[0, 1])
    if widest <= 0:
        return ranges.copy()
    first, last = _windows(bearings, widest, full_turn)
    return _vouched(bearings, ranges, first, last, beam)


def smeared(opened: Floats, tolerance: float, widest_step: int, full_turn: bool) -> Integers:
    """Readings (s,) of the opened profile (n,) that are bounds and no surface: what the beam could not see into.

    In a corner or a gap narrower than the beam one far reading vouches for a whole window, so the profile has a
    plateau that falls off on both sides. A wall met at right angles makes a plateau too, but rises from it.
    Plateaus are level within `tolerance` metres and at least `widest_step` readings wide.
    """
    n = opened.size
    laps = 2 if full_turn else 1
    found: list[int] = []
    start = 0
    while start < n:
        stop = start + 1
        while stop < laps * n and stop - start < n and abs(opened[stop % n] - opened[start]) <= tolerance:
            stop += 1
        inside = full_turn or (start > 0 and stop < n)
        if inside and widest_step <= stop - start < n:
            sides = opened[[start - 1, stop % n]]
            if np.all(sides < opened[start] - tolerance):
                found.extend(k % n for k in range(start, stop))
        start = stop
    return np.unique(np.array(found, np.int64))


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
def _vouched(bearings: Floats, ranges: Floats, first: Integers, last: Integers, beam: Floats) -> Floats:
    n = ranges.size
    farthest = np.full(n, np.nan)
    for i in range(n):
        for j in range(first[i], last[i] + 1):
            value = ranges[j % n]
            if np.isnan(value):
                continue
            aside = abs((bearings[i] - bearings[j % n] + np.pi) % (2 * np.pi) - np.pi)
            value = min(value, _heard_to(aside, beam))
            if not farthest[i] >= value:
                farthest[i] = value
    return farthest


@compiled
def _heard_to(aside: float, beam: Floats) -> float:
    """The range up to which a surface that far off the axis is heard; without limit on the axis itself."""
    if aside < 1e-9:
        return np.inf
    row = len(beam) - 1
    while row > 0 and beam[row, 1] < aside:
        row -= 1
    if row == len(beam) - 1:
        return float(beam[row, 0])
    share = (beam[row, 1] - aside) / max(beam[row, 1] - beam[row + 1, 1], 1e-12)
    return float(beam[row, 0] + max(share, 0.0) * (beam[row + 1, 0] - beam[row, 0]))
