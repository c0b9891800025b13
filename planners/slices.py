"""Cones cut into slices, each with the headings that are legal all through it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled
from planners.orientations import CIRCLE, legal_along

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

INTERVALS = 6  # kept per slice, the widest that the search needs are rarely more than two


class Slices(NamedTuple):
    """The slices of all cones, one cone after another.

    first (k + 1,): rows of cone k are first[k] to first[k + 1]. pieces (n, 4): both ends of a slice on the spine.
    legal (n, INTERVALS, 2) and counts (n,): its legal headings. reason, see `lost`: −1 where some heading is legal.
    """

    first: NDArray[np.int64]
    pieces: Floats
    legal: Floats
    counts: Ints


@compiled
def _near(spine: Floats, ends: Floats, reach: float) -> Floats:
    """The walls (k, 4) that come within `reach` of the box... of a spine's line."""
    x, y = spine[2] - spine[0], spine[3] - spine[1]
    length = np.hypot(x, y)
    x, y = x / length, y / length
    kept = np.empty((ends.shape[0], 4))
    count = 0
    for k in range(ends.shape[0]):
        first = x * (ends[k, 1] - spine[1]) - y * (ends[k, 0] - spine[0])
        second = x * (ends[k, 3] - spine[1]) - y * (ends[k, 2] - spine[0])
        if min(first, second) > reach or max(first, second) < -reach:
            continue
        first = x * (ends[k, 0] - spine[0]) + y * (ends[k, 1] - spine[1])
        second = x * (ends[k, 2] - spine[0]) + y * (ends[k, 3] - spine[1])
        if min(first, second) > length + reach or max(first, second) < -reach:
            continue
        for each in range(4):
            kept[count, each] = ends[k, each]
        count += 1
    return kept[:count].copy()


@compiled
def sliced(spines: Floats, ends: Floats, polar: Floats, body: Floats, step: float) -> tuple[Floats, Floats, Ints, Ints]:
    """Slice every spine (k, 8) where some heading is legal.

    body: (3,) radius, margin and reach of the robot. Returns pieces, legal, counts as in `Slices`, and the number of
    slices per spine; only the stretch of legal slices that touches the overlap of the two walls is kept.
    """
    capacity = 1024
    pieces, legal = np.empty((capacity, 4)), np.empty((capacity, INTERVALS, 2))
    counts, sizes = np.empty(capacity, np.int32), np.zeros(spines.shape[0], np.int32)
    used = 0
    for k in range(spines.shape[0]):
        spine = spines[k]
        near = _near(spine, ends, body[2])
        length = np.hypot(spine[2] - spine[0], spine[3] - spine[1])
        total = int(np.ceil(length / step))
        while used + total > pieces.shape[0]:
            pieces = np.concatenate((pieces, np.empty_like(pieces)))
            legal = np.concatenate((legal, np.empty_like(legal)))
            counts = np.concatenate((counts, np.empty_like(counts)))
        begin, touched = used, False
        for each in range(total):
            for axis in range(2):
                rise = spine[2 + axis] - spine[axis]
                pieces[used, axis] = spine[axis] + rise * each / total
                pieces[used, 2 + axis] = spine[axis] + rise * (each + 1) / total
            found = legal_along(polar, body[0], pieces[used], near, body[1])
            if found.shape[0] == 0:
                if touched:
                    break
                used = begin
                continue
            counts[used] = min(found.shape[0], INTERVALS)
            for one in range(counts[used]):
                legal[used, one, 0], legal[used, one, 1] = found[one, 0], found[one, 1]
            here, there = each * length / total, (each + 1) * length / total
            touched = touched or (here <= spine[7] and there >= spine[6])
            used += 1
        if not touched:
            used = begin
        sizes[k] = used - begin
    return pieces[:used].copy(), legal[:used].copy(), counts[:used].copy(), sizes
