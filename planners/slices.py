"""Cones cut into slices, each with the headings that are legal all through it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled, kernel
from planners.insertion import order_of
from planners.orientations import legal_along, nearest

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

INTERVALS = 6  # kept per slice; the rest is given up, which is sound
HALVINGS = 4  # of a slice without legal headings, to find where it loses them


class Slices(NamedTuple):
    """The slices of all cones, one cone after another.

    first (k + 1,): rows of cone k are first[k] to first[k + 1]. pieces (n, 4): both ends of a slice on the spine.
    legal (n, INTERVALS, 2) and counts (n,): its legal headings, never none. places (n,): twice the cone's number plus
    where the slice begins on the spine, 0 … 1; increasing. tightness (n,): 0 where the walls are as far as the robot is
    wide, 1 where one is half as far.
    """

    first: NDArray[np.int64]
    pieces: Floats
    legal: Floats
    counts: Ints
    places: Floats
    tightness: Floats


class Body(NamedTuple):
    """A robot among walls. polar (v, 2): distance and angle of its corners; radius it is rounded by; ends (m, 4) of
    the walls; margin to keep from them; reach of the robot with the margin, and its least
    width; step: length of a slice; caution: extra cost of a metre where it is
    tightest."""

    polar: Floats
    radius: float
    ends: Floats
    margin: float
    reach: float
    width: float
    step: float
    caution: float


@kernel
def _near(spine: Floats, ends: Floats, reach: float) -> Floats:
    """The walls (k, 4) that come within `reach` of a spine, measured along and across it."""
    x, y = spine[2] - spine[0], spine[3] - spine[1]
    length = np.hypot(x, y)
    x, y = x / length, y / length
    kept, count = np.empty_like(ends), 0
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


@kernel
def _part(spine: Floats, begin: float, end: float) -> Floats:
    """The piece (4,) of a spine between two places 0 … 1."""
    piece = np.empty(4)
    for axis in range(2):
        rise = spine[2 + axis] - spine[axis]
        piece[axis], piece[2 + axis] = spine[axis] + rise * begin, spine[axis] + rise * end
    return piece


@kernel
def _seed(spine: Floats, near: Floats, body: Body, whole: float) -> tuple[float, float]:
    """Place and width of a slice with legal headings on the overlap of a spine's two walls; width 0 without."""
    length = np.hypot(spine[2] - spine[0], spine[3] - spine[1])
    low, high = spine[6] / length, spine[7] / length
    tries = int(np.ceil((high - low) / whole))
    for each in range(tries):
        place, width = low + (high - low) * (each + 0.5) / tries, whole
        for _ in range(HALVINGS + 1):
            begin, end = max(place - width / 2, 0.0), min(place + width / 2, 1.0)
            if legal_along(body.polar, body.radius, _part(spine, begin, end), near, body.margin).shape[0] > 0:
                return begin, end - begin
            width /= 2
    return 0.0, 0.0


@kernel
def _grown(spine: Floats, near: Floats, body: Body) -> tuple[Floats, Floats]:
    """Places (n, 2) and legal headings (n, INTERVALS, 2), padded with nan, of the slices around the overlap.

    Slices are added on both sides until none has legal headings; there shorter ones are tried.
    """
    whole = body.step / np.hypot(spine[2] - spine[0], spine[3] - spine[1])
    places, legal, count = np.empty((64, 2)), np.full((64, INTERVALS, 2), np.nan), 0
    seed, first = _seed(spine, near, body, whole)
    for side in range(2 if first > 0 else 0):
        front, width = seed, first if side == 0 else whole
        while width > whole / 2 ** (HALVINGS + 1) and (front < 1.0 if side == 0 else front > 0.0):
            begin, end = (front, min(front + width, 1.0)) if side == 0 else (max(front - width, 0.0), front)
            found = legal_along(body.polar, body.radius, _part(spine, begin, end), near, body.margin)
            if found.shape[0] == 0:
                width /= 2
                continue
            if count == places.shape[0]:
                places, legal = np.concatenate((places, places)), np.concatenate((legal, np.full_like(legal, np.nan)))
            places[count, 0], places[count, 1] = begin, end
            for k in range(min(found.shape[0], INTERVALS)):
                legal[count, k, 0], legal[count, k, 1] = found[k, 0], found[k, 1]
            front, width, count = end if side == 0 else begin, min(2 * width, whole), count + 1
    order = order_of(places[:count, 0].copy())
    return places[order], legal[order]


@compiled
def sliced(spines: Floats, body: Body) -> tuple[Ints, Floats, Floats, Floats]:
    """Slices per spine (k,), their pieces (n, 4), legal headings (n, INTERVALS, 2) and room to the nearest wall (n,).

    spines: rows (k, 8) of `freeways.spines`.
    """
    pieces, legal, rooms, used = np.empty((1024, 4)), np.empty((1024, INTERVALS, 2)), np.empty(1024), 0
    sizes = np.zeros(spines.shape[0], np.int32)
    for k in range(spines.shape[0]):
        near = _near(spines[k], body.ends, body.reach + body.width)
        places, headings = _grown(spines[k], near, body)
        while used + places.shape[0] > pieces.shape[0]:
            pieces, legal = np.concatenate((pieces, pieces)), np.concatenate((legal, legal))
            rooms = np.concatenate((rooms, rooms))
        for row in range(places.shape[0]):
            piece = _part(spines[k], places[row, 0], places[row, 1])
            for each in range(4):
                pieces[used, each] = piece[each]
            rooms[used] = body.width
            for each in range(near.shape[0]):
                rooms[used] = min(rooms[used], nearest(piece, near[each])[2])
            for each in range(INTERVALS):
                legal[used, each, 0], legal[used, each, 1] = headings[row, each, 0], headings[row, each, 1]
            used += 1
        sizes[k] = places.shape[0]
    return sizes, pieces[:used].copy(), legal[:used].copy(), rooms[:used].copy()


def slices_of(spines: Floats, body: Body) -> tuple[Slices, NDArray[np.bool_]]:
    """The slices of all `spines` (k, 8), and which of them (k,) kept any."""
    sizes, pieces, legal, rooms = sliced(spines, body)
    first = np.concatenate([[0], np.cumsum(sizes[sizes > 0])]).astype(np.int64)
    counts = np.isfinite(legal[:, :, 0]).sum(axis=1).astype(np.int32)
    owner = np.repeat(np.arange(len(first) - 1), np.diff(first))
    begin, end = pieces[first[:-1], :2], pieces[first[1:] - 1, 2:]
    along = np.linalg.norm(pieces[:, :2] - begin[owner], axis=1) / np.linalg.norm(end - begin, axis=1)[owner]
    tightness = np.clip(2 - 2 * rooms / body.width, 0, 1)
    return Slices(first, pieces, legal, counts, 2 * owner + along, tightness), sizes > 0
