"""The primitives of curvature: corners and what pairs of them make; smooth joins (Brady 1984; Asada & Brady 1986)."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from frontend.compiled import compiled
from frontend.scale_space import ScaleSpace
from frontend.scan import Floats, Integers


class Primitive(IntEnum):
    """What a significant change of curvature belongs to. Counter-clockwise with the free space on the left."""

    CORNER = 0
    SMOOTH_JOIN = 1  # straight meets curved
    END = 2  # two corners of one sign close together
    CRANK = 3  # two corners of opposite sign: the wall steps aside
    BUMP = 4  # two cranks of opposite sense: something stands out into the free space
    DENT = 5  # the same into the wall


@dataclass(frozen=True)
class PrimitiveSettings:
    """Opinions of the classification; lengths in metres."""

    widest_pair: float = 0.6  # between the corners of an end or crank; larger calls more corners pairs
    widest_group: float = 1.5  # of a bump or dent; larger takes furniture for bumps
    least_curvature: float = 0.8  # step of curvature of a smooth join, 1/m; larger keeps only tight curves
    significance: float = 6.0  # sigmas of the noise law; larger keeps only clearer joins


def classify(turns: Floats, places: Floats, settings: PrimitiveSettings) -> NDArray[np.uint8]:
    """Primitive (t,) of the corners of one chain, by their turns (t,) and places (t,) along it."""
    kinds = np.full(turns.size, Primitive.CORNER, dtype=np.uint8)
    signs = np.sign(turns)
    close = np.diff(places) < settings.widest_pair
    for t in map(int, np.flatnonzero(close)):
        pair = kinds[t : t + 2]
        pair[:] = np.maximum(pair, Primitive.END if signs[t] == signs[t + 1] else Primitive.CRANK)
    for t in range(turns.size - 3):
        inside = places[t + 3] - places[t] < settings.widest_group
        if inside and signs[t] == signs[t + 3] == -signs[t + 1] == -signs[t + 2]:
            kinds[t : t + 4] = Primitive.BUMP if signs[t] > 0 else Primitive.DENT
    return kinds


def smooth_joins(space: ScaleSpace, corners: Floats, noise: float, settings: PrimitiveSettings) -> Integers:
    """Places (j,) on the scale space where straight meets curved.

    (G∗θ)″ peaks at Δκ / (σ√(2π)) there and, unlike at a corner, without a partner of the opposite sign beside it.
    Judged at the middle scale, away from corners (c,) and from the chain's ends by three sigmas.
    """
    level = space.sigmas.size // 2
    sigma, spacing = float(space.sigmas[level]), float(space.arc_length[1])
    if space.arc_length[-1] < 6 * sigma:
        return np.empty(0, dtype=np.int64)
    floor = max(settings.least_curvature, settings.significance * _noise_of_steps(sigma, noise, spacing))
    return lone_steps(space.turns[level], corners, spacing, sigma, floor)


@compiled
def lone_steps(turns: Floats, corners: Floats, spacing: float, sigma: float, floor: float) -> Integers:
    """Places (j,) of the largest steps of curvature over the floor that have no opposite partner beside them."""
    m, reach = turns.size, int(np.ceil(2.5 * sigma / spacing))  # a corner's two flanks lie 2 sigmas apart
    steps = np.zeros(m)  # σ√(2π)·(G∗θ)″
    steps[1:-1] = (turns[2:] - turns[:-2]) / (2 * spacing)
    joins = np.empty(m, dtype=np.int64)
    found = 0
    for i in range(int(2 * sigma / spacing) + 1, m - int(2 * sigma / spacing) - 1):
        size = abs(steps[i])
        if size <= floor or np.any(np.abs(corners - i * spacing) <= 3 * sigma):
            continue
        around = steps[max(i - reach, 0) : i + reach + 1] * np.sign(steps[i])
        if np.max(around) <= size and -np.min(around) < 0.5 * size:
            joins[found] = i
            found += 1
    return joins[:found]


def _noise_of_steps(sigma: float, noise: float, spacing: float) -> float:
    """Standard deviation of a step of curvature: that of (G∗θ)″ for noise e at spacing h, times σ√(2π)."""
    return float(noise * np.sqrt(2 * np.pi) * np.sqrt(15 * spacing / (16 * np.sqrt(np.pi))) * sigma**-2.5)
