"""Scale space of the boundary: its tangent orientation smoothed with Gaussians of several widths (Flynn 1988, §4).

Everything here is metres along one real chain. A corner of turn φ reads φ at every scale in `turns`, because
(G∗θ)′ peaks at φ / (σ√(2π)); pairs and curves read differently at different scales, which tells them apart.
"""

from dataclasses import dataclass

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Floats, Integers


@dataclass(frozen=True, eq=False)
class ScaleSpace:
    """Of one chain: arc_length (m,), points (m, 2) evenly spaced, sigmas (l,), turns (l, m) in radians.

    turns: σ√(2π)·(G∗θ)′, the turn a corner at that place would have.
    """

    arc_length: Floats
    points: Floats
    sigmas: Floats
    turns: Floats


def scale_space(points: Floats, sigmas: Floats, spacing: float) -> ScaleSpace:
    """The scale space of a chain of points (n, 2), n ≥ 2. sigmas: (l,) metres, fine to coarse."""
    even, walked = resampled(points, arc_lengths(points), spacing)
    return ScaleSpace(even, walked, sigmas, chain_turns(walked, even[1], sigmas))


@compiled
def arc_lengths(points: Floats) -> Floats:
    """Metres (n,) along a chain of points (n, 2) from its first."""
    lengths = np.zeros(points.shape[0])
    for i in range(1, points.shape[0]):
        step = np.hypot(points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1])
        lengths[i] = lengths[i - 1] + step
    return lengths


@compiled
def resampled(points: Floats, arc: Floats, spacing: float) -> tuple[Floats, Floats]:
    """Arc lengths (m,) and points (m, 2) of a chain at even steps of at most `spacing`, three points at least."""
    count = max(int(np.ceil(arc[-1] / spacing - 1e-9)) + 1, 3)
    even, walked = np.linspace(0.0, arc[-1], count), np.empty((count, 2))
    walked[:, 0] = np.interp(even, arc, points[:, 0].copy())
    walked[:, 1] = np.interp(even, arc, points[:, 1].copy())
    return even, walked


@compiled
def chain_turns(points: Floats, spacing: float, sigmas: Floats) -> Floats:
    """Scale-normalised turns (l, m) of evenly spaced points (m, 2) at each sigma (l,).

    Half the finest sigma smooths the positions, so that a dense noisy wall has an orientation at all; the rest smooths
    that orientation. Ends continue by reflection through the end point, which leaves a wall straight.
    """
    m = points.shape[0]
    first = 0.5 * sigmas[0]
    orientation = _orientation(points, spacing, first)
    turns = np.empty((sigmas.size, m))
    for level in range(sigmas.size):
        sigma = sigmas[level]
        extra = np.sqrt(sigma**2 - first**2)
        reach = int(np.ceil(3.5 * extra / spacing))
        offsets = np.arange(-reach, reach + 1) * spacing
        slope = offsets * np.exp(-0.5 * (offsets / extra) ** 2)
        slope *= sigma * np.sqrt(2 * np.pi) / np.sum(slope * offsets)
        padded = np.empty(m + 2 * reach)
        for i in range(m + 2 * reach):
            padded[i] = orientation[_reflected(i - reach, m)]
        for i in range(m):
            turns[level, i] = np.dot(slope, padded[i : i + 2 * reach + 1])
    return turns


@compiled
def _orientation(points: Floats, spacing: float, sigma: float) -> Floats:
    """Unwrapped tangent orientation (m,) of the points smoothed with sigma."""
    m = points.shape[0]
    reach = int(np.ceil(3.5 * sigma / spacing))
    offsets = np.arange(-reach, reach + 1) * spacing
    slope = offsets * np.exp(-0.5 * (offsets / sigma) ** 2)
    orientation = np.empty(m)
    for i in range(m):
        x, y = 0.0, 0.0
        for k in range(-reach, reach + 1):
            j = _reflected(i + k, m)
            px, py = points[j, 0], points[j, 1]
            if i + k < 0:
                px, py = 2 * points[0, 0] - px, 2 * points[0, 1] - py
            elif i + k >= m:
                px, py = 2 * points[m - 1, 0] - px, 2 * points[m - 1, 1] - py
            x += slope[k + reach] * px
            y += slope[k + reach] * py
        angle = np.arctan2(y, x)
        if i > 0:
            turn = angle - orientation[i - 1]
            angle -= 2 * np.pi * np.round(turn / (2 * np.pi))
        orientation[i] = angle
    return orientation


@compiled
def _reflected(i: int, m: int) -> int:
    """Index i brought into 0…m − 1 by reflection at the ends, without repeating them."""
    period = 2 * (m - 1)
    i = abs(i) % period
    return i if i < m else period - i


@dataclass(frozen=True, eq=False)
class Tracks:
    """Extrema of the turns followed over the scales: place (t,) index at the finest, first and last level (t,)."""

    place: Integers
    first: Integers
    last: Integers


def tracks(space: ScaleSpace, thresholds: Floats) -> Tracks:
    """Extrema over the thresholds (l,) followed from fine to coarse; each track keeps its sign."""
    spacing = float(space.arc_length[1])
    place, first, last = follow_extrema(space.turns, thresholds, space.sigmas / spacing)
    return Tracks(place, first, last)


def track_paths(space: ScaleSpace, thresholds: Floats) -> list[Integers]:
    """For each track, its level and its place there (k, 2), fine to coarse: the nearest extremum of its sign."""
    found, paths = tracks(space, thresholds), []
    for place, first, last in zip(found.place, found.first, found.last, strict=True):
        path, here = [], int(place)
        for level in range(int(first), int(last) + 1):
            row = space.turns[level] * np.sign(space.turns[first, place])
            peaks = np.flatnonzero((row > 0) & (row >= np.append(0.0, row[:-1])) & (row > np.append(row[1:], 0.0)))
            here = int(peaks[np.argmin(np.abs(peaks - here))])
            path.append((level, here))
        paths.append(np.array(path))
    return paths


@compiled
def follow_extrema(turns: Floats, thresholds: Floats, reaches: Floats) -> tuple[Integers, Integers, Integers]:
    """Place, first and last level (t,) of each track; an extremum joins the nearest one within a sigma above it."""
    levels, m = turns.shape
    place, first, last, head = (
        [0 for _ in range(0)],
        [0 for _ in range(0)],
        [0 for _ in range(0)],
        [0 for _ in range(0)],
    )
    for level in range(levels):
        row = turns[level]
        for i in range(m):
            size = abs(row[i])
            before = abs(row[i - 1]) if i > 0 else 0.0
            after = abs(row[i + 1]) if i < m - 1 else 0.0
            if size < thresholds[level] or size < before or size <= after:
                continue
            chosen, nearest = -1, reaches[level] + 1.0
            for t in range(len(place)):
                gap = abs(head[t] - i)
                same = turns[last[t], head[t]] * row[i] > 0
                if last[t] == level - 1 and same and gap < nearest:
                    chosen, nearest = t, gap
            if chosen >= 0:
                head[chosen] = i
                last[chosen] = level
            else:
                place.append(i)
                first.append(level)
                last.append(level)
                head.append(i)
    return np.array(place, dtype=np.int64), np.array(first, dtype=np.int64), np.array(last, dtype=np.int64)
