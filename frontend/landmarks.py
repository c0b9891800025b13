"""Landmark knots: significant corners of one real chain, found in scale space, placed where two lines meet.

Only surface that was measured on both sides can make one: an edge of sight moves with the viewpoint.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from frontend.compiled import compiled
from frontend.lines import crossing, fit_line
from frontend.primitives import Primitive, PrimitiveSettings, classify, smooth_joins
from frontend.scale_space import ScaleSpace, arc_lengths, chain_turns, follow_extrema, resampled, scale_space
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True)
class LandmarkSettings:
    """Opinions of the landmark search; lengths in metres, angles in radians."""

    finest: float = 0.1  # smallest sigma; larger ignores more clutter and noise
    scales: int = 5  # sigmas, each √2 coarser than the one before; more asks for longer walls
    spacing: float = 0.04  # of the resampled boundary; larger is cheaper and blurs places
    least_turn: float = 0.4  # larger keeps only sharper corners
    significance: float = 3.0  # sigmas of the noise law; larger keeps only clearer corners
    support: float = 1.0  # metres of wall used on each side of a knot; larger is surer on straight walls
    least_support: float = 0.12  # metres of wall a side must have; larger drops knots near chain ends
    least_points: int = 3  # readings a side must have; larger drops far knots
    roughness: float = 4.0  # rms across the fitted lines in units of the noise; larger takes rough or curved walls
    primitives: PrimitiveSettings = field(default_factory=PrimitiveSettings)

    @property
    def sigmas(self) -> Floats:
        """(l,) metres, fine to coarse."""
        return np.asarray(self.finest * np.sqrt(2.0) ** np.arange(self.scales))

    @property
    def limits(self) -> Floats:
        """What compiled loops need of these: support, least support and points, roughness, least turn, significance."""
        return np.array([self.support, self.least_support, self.least_points,
                         self.roughness, self.least_turn, self.significance])  # fmt: skip


@dataclass(frozen=True, eq=False)
class ChainKnots:
    """Knots of one chain, in its order.

    kinds (t,) Primitive, positions (t, 2), turns (t,) counter-clockwise, headings (t,) of the bisector to free space,
    covariances (t, 2, 2), scales (t, 2) finest and coarsest sigma they live at, places (t,) index of the reading
    in the chain that the knot follows. Smooth joins have a place but no crossing lines: their covariance is that of a
    curve, sigma along it.
    """

    kinds: NDArray[np.uint8]
    positions: Floats
    turns: Floats
    headings: Floats
    covariances: Floats
    scales: Floats
    places: Integers


@dataclass(frozen=True, eq=False)
class Corners:
    """The corners of all chains of a contour: columns as in the chain's knots."""

    positions: Floats
    turns: Floats
    headings: Floats
    covariances: Floats


def corners(points: Floats, real: Booleans, noise: Floats, settings: LandmarkSettings) -> Corners:
    """The corners on the surface of a contour (n, 2), free space on its left: what poses need, and nothing else.

    real: (n,) whether the edge from a point to the next, cyclically, is surface. noise: (n,) metres.
    """
    rows = corners_of_chains(points, real, noise, settings.sigmas, settings.spacing, settings.limits)
    return Corners(
        rows[:, :2], rows[:, 5], np.pi - np.mod(np.pi - rows[:, 6], 2 * np.pi), rows[:, [2, 3, 3, 4]].reshape(-1, 2, 2)
    )


def chain_knots(points: Floats, noise: float, settings: LandmarkSettings) -> ChainKnots:
    """The knots of a chain of points (n, 2), free space on its left: its corners, then its smooth joins."""
    arc = arc_lengths(points)
    if points.shape[0] < 2 * settings.least_points or arc[-1] < 2 * settings.least_support:
        return _from_rows(np.empty((0, 11)), np.empty(0, dtype=np.int64), settings)
    sigmas = settings.sigmas
    space = scale_space(points, sigmas, settings.spacing)
    rows, at = corners_of_chain(points, arc, noise, space.turns, sigmas, settings.limits)
    found = _from_rows(rows, np.searchsorted(arc, rows[:, 10]) - 1, settings)
    joins = smooth_joins(space, at, noise, settings.primitives)
    return _with_joins(found, space, joins, np.maximum(np.searchsorted(arc, space.arc_length[joins]) - 1, 0))


@compiled
def corners_of_chains(
    points: Floats, real: Booleans, noise: Floats, sigmas: Floats, spacing: float, limits: Floats
) -> Floats:
    """Rows (t, 11), as of one chain, of all chains of vertices (n, 2) joined by real edges."""
    n = points.shape[0]
    first = 0  # a chain that runs over the end of the list is read from its own beginning
    while first < n and real[first - 1]:
        first += 1
    first %= n
    rows, start = np.empty((0, 11)), 0
    while start < n:
        stop = start
        while stop < start + n - 1 and real[(first + stop) % n]:
            stop += 1
        if stop - start + 1 >= 2 * limits[2]:
            readings = (first + np.arange(start, stop + 1)) % n
            chain = points[readings]
            arc = arc_lengths(chain)
            if arc[-1] >= 2 * limits[1]:
                even, walked = resampled(chain, arc, spacing)
                turns = chain_turns(walked, even[1], sigmas)
                found, _ = corners_of_chain(chain, arc, np.mean(noise[readings]), turns, sigmas, limits)
                rows = np.concatenate((rows, found))
        start = stop + 1
    return rows


@compiled
def corners_of_chain(
    points: Floats, arc: Floats, noise: float, turns: Floats, sigmas: Floats, limits: Floats
) -> tuple[Floats, Floats]:
    """Corners (t, 11) as `place_corners`, then finest and coarsest sigma and place along it; also all places (c,)."""
    step = arc[-1] / (arc.size - 1)
    spacing = arc[-1] / (turns.shape[1] - 1)
    place, first, last = follow_extrema(turns, thresholds(sigmas, noise, step, limits), sigmas / spacing)
    order = np.argsort(place)
    at = place[order] * spacing
    placed, kept = place_corners(points, arc, at, noise, limits)
    rows = np.empty((len(kept), 11))
    rows[:, :8], rows[:, 10] = placed, at[kept]
    for k in range(len(kept)):
        rows[k, 8], rows[k, 9] = sigmas[first[order[kept[k]]]], sigmas[last[order[kept[k]]]]
    return rows, at


@compiled
def thresholds(sigmas: Floats, noise: float, step: float, limits: Floats) -> Floats:
    """Least turn (l,) that stands out of the noise at each sigma: k·e·√(2π)·√(3h / 8√π)·σ^(−3/2)."""
    law = np.sqrt(2 * np.pi) * np.sqrt(3 * step / (8 * np.sqrt(np.pi))) * sigmas**-1.5
    return np.asarray(np.maximum(limits[4], limits[5] * noise * law))


@compiled
def place_corners(points: Floats, arc: Floats, at: Floats, noise: float, limits: Floats) -> tuple[Floats, Integers]:
    """Corners (t, 8) x, y, xx, xy, yy, turn, heading, rms from line fits left and right of the candidates `at` (c,).

    Also the candidates kept (t,). A candidate is dropped when a side is too short, too rough, or hardly turns.
    """
    support, least_support, least_points, roughness, least_turn, significance = limits
    rows = np.empty((at.size, 8))
    kept = np.empty(at.size, dtype=np.int64)
    found = 0
    for c in range(at.size):
        left = max(at[c - 1] if c > 0 else 0.0, at[c] - support)
        right = min(at[c + 1] if c < at.size - 1 else arc[-1], at[c] + support)
        a, b = np.searchsorted(arc, left - 1e-9), np.searchsorted(arc, at[c])
        d = np.searchsorted(arc, right + 1e-9)
        if min(b - a, d - b) < least_points or min(at[c] - left, right - at[c]) < least_support:
            continue
        first, second = fit_line(points, a, b, noise), fit_line(points, b, d, noise)
        turn = (second[2] - first[2] + np.pi) % (2 * np.pi) - np.pi
        meet = crossing(first, second)
        gap = np.hypot(meet[0] - points[b, 0], meet[1] - points[b, 1])
        step = np.hypot(points[b, 0] - points[b - 1, 0], points[b, 1] - points[b - 1, 1])
        if max(first[5], second[5]) > roughness * noise or not gap < 2 * step + 0.1:
            continue
        if abs(turn) < max(least_turn, significance * np.sqrt(first[4] + second[4])):
            continue
        rows[found, :5] = meet
        rows[found, 5] = turn
        rows[found, 6] = first[2] + 0.5 * turn + 0.5 * np.pi
        rows[found, 7] = max(first[5], second[5])
        kept[found] = c
        found += 1
    return rows[:found], kept[:found]


def _from_rows(rows: Floats, places: Integers, settings: LandmarkSettings) -> ChainKnots:
    return ChainKnots(
        kinds=classify(rows[:, 5], rows[:, 10], settings.primitives),
        positions=rows[:, :2],
        turns=rows[:, 5],
        headings=np.pi - np.mod(np.pi - rows[:, 6], 2 * np.pi),
        covariances=rows[:, [2, 3, 3, 4]].reshape(-1, 2, 2),
        scales=rows[:, 8:10],
        places=places,
    )


def _with_joins(corners: ChainKnots, space: ScaleSpace, joins: Integers, places: Integers) -> ChainKnots:
    """The corners and the smooth joins, which turn nothing and are known to the coarsest sigma."""
    if not joins.size:
        return corners
    along = space.points[joins + 1] - space.points[joins - 1]
    sigma = space.sigmas[-1]
    return ChainKnots(
        kinds=np.append(corners.kinds, np.full(joins.size, Primitive.SMOOTH_JOIN, dtype=np.uint8)),
        positions=np.vstack([corners.positions, space.points[joins]]),
        turns=np.append(corners.turns, np.zeros(joins.size)),
        headings=np.append(corners.headings, np.arctan2(along[:, 0], -along[:, 1])),
        covariances=np.concatenate([corners.covariances, np.tile(sigma**2 * np.eye(2), (joins.size, 1, 1))]),
        scales=np.vstack([corners.scales, np.full((joins.size, 2), sigma)]),
        places=np.append(corners.places, places),
    )
