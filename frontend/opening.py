"""Undoing the beam: the opened profile of a wide sensor.

On rough surfaces a wide beam reports the nearest echo inside it, so the profile over the bearing is a minimum filter of
the true polar profile, and its opening is what surely is free: exact on walls wider than the beam, short (never long)
in corners and narrow gaps. A near surface is heard farther off the axis than a far one, so the beam narrows with the
range: a reading says that nothing lies nearer than it, at each angle off its axis as far as surfaces are heard there.
"""

import numpy as np
from scipy.special import ndtri

from frontend.compiled import compiled
from frontend.scan import Floats, Integers


def undo_beam(bearings: Floats, ranges: Floats, beam: Floats, noise: float, full_turn: bool) -> Floats:
    """The opened profile (n,) of `ranges` (n,) at `bearings` (n,): the farthest that any reading vouches for.

    beam: (k, 2) rows of metres and radians, the half-beam narrowing from row to row. A reading vouches for its own
    range on its axis, and off it for no more than the range at which the half-beam has narrowed to that angle.
    Readings that must not spread (no echo, rejected) are nan and vouch for nothing; nan where nobody vouches.
    noise: metres, of a reading. The farthest of many noisy readings of one wall lies beyond it by what is to be
    expected of their number, and is drawn back by that.
    """
    widest = float(beam[0, 1])
    if widest <= 0:
        return ranges.copy()
    first, last = _windows(bearings, widest, full_turn)
    smooth = _smoothed(ranges, full_turn)
    farthest, rivals, excess = _vouched(bearings, ranges, smooth, np.column_stack([first, last]), beam, noise)
    return np.asarray(farthest - np.minimum(noise * expected_maxima(int(np.max(rivals)))[rivals], excess))


def expected_maxima(most: int) -> Floats:
    """Expected maximum (most + 1,) of so many standard normal values, 0 of none (Blom 1958)."""
    counts = np.arange(1, most + 1)
    return np.concatenate([[0.0], ndtri((counts - 0.375) / (counts + 0.25))])


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


def _smoothed(ranges: Floats, full_turn: bool) -> Floats:
    """Mean (n,) of each reading and its two neighbours on both sides; nan where one of them is."""
    padded = np.pad(ranges, 2, mode="wrap" if full_turn else "edge")
    return np.asarray(np.mean(np.stack([padded[k : k + ranges.size] for k in range(5)]), axis=0))


@compiled
def _vouched(
    bearings: Floats, ranges: Floats, smooth: Floats, windows: Integers, beam: Floats, noise: float
) -> tuple[Floats, Integers, Floats]:
    """The farthest vouched for (n,), how many readings (n,) noise alone keeps from being it, and its lead on them (n,).

    Rivals are told by the smoothed ranges, which know the wall better than a reading does.
    """
    n = ranges.size
    farthest, rivals, lead = np.full(n, np.nan), np.ones(n, dtype=np.int64), np.zeros(n)
    for i in range(n):
        limited, top = False, 0.0
        for j in range(windows[i, 0], windows[i, 1] + 1):
            value = _said(bearings, ranges, beam, i, j % n)
            if not np.isnan(value) and not farthest[i] >= value:
                farthest[i], limited = value, value < ranges[j % n]
            if value == ranges[j % n] and smooth[j % n] > top:
                top = smooth[j % n]
        if np.isnan(farthest[i]) or limited:  # what the beam's reach limits has no noise
            continue
        count, total = 0, 0.0
        for j in range(windows[i, 0], windows[i, 1] + 1):
            value = _said(bearings, ranges, beam, i, j % n)
            if value == ranges[j % n] and smooth[j % n] >= top - noise:
                count, total = count + 1, total + value
        if count > 1:
            rivals[i], lead[i] = count, max(farthest[i] - total / count, 0.0)
    return farthest, rivals, lead


@compiled
def _said(bearings: Floats, ranges: Floats, beam: Floats, i: int, j: int) -> float:
    """How far reading j vouches for free space along bearing i; nan for a reading that vouches for nothing."""
    aside = abs((bearings[i] - bearings[j] + np.pi) % (2 * np.pi) - np.pi)
    return float(ranges[j] if np.isnan(ranges[j]) else min(ranges[j], _heard_to(aside, beam)))


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
