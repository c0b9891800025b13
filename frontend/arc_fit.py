"""A wall as a wide beam reads it, compiled: a region of constant depth about its foot, then a slow rise to both sides.

The first echo inside the beam gives the range, so a wall at distance ρ reads ρ within the half-beam α of its normal
and ρ/cos ψ at ψ + α beside it (Leonard & Durrant-Whyte 1992, for walls that scatter). α shrinks with the range as
the sensor's facts say, times a strength that is fitted along.
"""

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Booleans, Floats

STEEPEST = 76  # degrees of incidence up to which a wall is modelled
STEP = 0.01  # radians, metres and share of the strength for derivatives by differences


@compiled
def turned(angle: float) -> float:
    """An angle brought into [−π, π)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


@compiled
def wall_ranges(aside: Floats, wall: Floats, beam: Floats) -> Floats:
    """Ranges (n,) that a wall (3,) of foot range, bearing and strength gives at angles (n,) off its normal.

    beam: (b, 2) rows of metres and half-beam. Infinite where the wall is met at too steep an incidence.
    """
    depths, reaches, widest = np.empty(STEEPEST), np.empty(STEEPEST), 0.0
    for k in range(STEEPEST):
        depths[k] = wall[0] / np.cos(np.radians(float(k)))
        half = wall[2] * np.interp(depths[k], beam[:, 0].copy(), beam[:, 1].copy())
        widest = max(widest + 1e-9, np.radians(float(k)) + half)
        reaches[k] = widest
    ranges = np.interp(np.abs(aside), reaches, depths)
    for i in range(len(aside)):
        if np.abs(aside[i]) > widest:
            ranges[i] = np.inf
    return ranges


@compiled
def read_as_wall(
    bearings: Floats, ranges: Floats, wall: Floats, beam: Floats, noise: Floats, around: int, cyclic: bool
) -> tuple[Booleans, Floats, Floats]:
    """Which readings (n,) around the one at index `around` are read off the wall, the model (n,), and its spread (n,).

    noise: range noise, radians by which the edge of the beam jitters, gate in sigmas, misses in a row that end it.
    """
    n = len(bearings)
    aside = np.empty(n)
    for i in range(n):
        aside[i] = turned(bearings[i] - wall[1])
    model = wall_ranges(aside, wall, beam)
    before, after = wall_ranges(aside - STEP, wall, beam), wall_ranges(aside + STEP, wall, beam)
    spread = np.empty(n)
    for i in range(n):
        slope = abs(after[i] - before[i]) / (2 * STEP) if np.isfinite(after[i]) and np.isfinite(before[i]) else 10.0
        spread[i] = np.hypot(noise[0], slope * noise[1])
    held = np.zeros(n, np.bool_)
    for way in (1, -1):
        misses = 0
        for k in range(n // 2):
            i = around + way * k
            if not cyclic and (i < 0 or i >= n):
                break
            i %= n
            if abs(ranges[i] - model[i]) < noise[2] * spread[i]:
                held[i], misses = True, 0
            else:
                misses += 1
                if misses > noise[3]:
                    break
    return held, model, spread


@compiled
def fit_wall(
    bearings: Floats, ranges: Floats, wall: Floats, beam: Floats, noise: Floats, strength: Floats, around: int,
    cyclic: bool,
) -> tuple[Floats, Floats, Booleans]:  # fmt: skip
    """Gauss–Newton on a wall (3,) from its readings: the wall, its information (3, 3), and which readings (n,) hold it.

    strength: (2,) what is expected of it and its spread.
    """
    best = wall.copy()
    information = np.zeros((3, 3))
    held = np.zeros(len(bearings), np.bool_)
    for _ in range(8):
        held, model, spread = read_as_wall(bearings, ranges, best, beam, noise, around, cyclic)
        used = np.flatnonzero(held)
        aside = np.empty(len(used))
        for k in range(len(used)):
            aside[k] = turned(bearings[used[k]] - best[1])
        deeper, stronger = best.copy(), best.copy()
        deeper[0] += STEP
        stronger[2] += STEP
        rows = np.empty((len(used), 3))
        rows[:, 0] = wall_ranges(aside, deeper, beam)
        rows[:, 1] = (wall_ranges(aside - STEP, best, beam) - wall_ranges(aside + STEP, best, beam)) / 2
        rows[:, 2] = wall_ranges(aside, stronger, beam)
        information = np.diag(np.array([1e-3, 1e-3, 1 / strength[1] ** 2]))
        pull = np.array([0.0, 0.0, (strength[0] - best[2]) / strength[1] ** 2])
        for k in range(len(used)):
            i = used[k]
            row = np.array([rows[k, 0] - model[i], rows[k, 1], rows[k, 2] - model[i]]) / STEP
            if not np.all(np.isfinite(row)):
                continue
            information += np.outer(row, row) / spread[i] ** 2
            pull += row * ((ranges[i] - model[i]) / spread[i] ** 2)
        move = np.linalg.solve(information, pull)
        best[0] += min(max(move[0], -0.1), 0.1)
        best[1] += min(max(move[1], -0.15), 0.15)
        best[2] = min(max(best[2] + move[2], 0.4), 2.5)
        if abs(move[0]) < 1e-3 and abs(move[1]) < 1e-3:
            break
    return best, information, held


@compiled
def level(ranges: Floats, depth: float, tolerance: float, around: int, cyclic: bool) -> tuple[int, int, bool, bool]:
    """The region of constant depth about a reading: steps to its last reading rightwards and leftwards, and whether
    what lies beyond each end is farther."""
    n = len(ranges)
    steps, opens = np.zeros(2, np.int64), np.zeros(2, np.bool_)
    for side in range(2):
        way = 2 * side - 1
        misses = 0
        for k in range(1, n // 2):
            i = around + way * k
            if not cyclic and (i < 0 or i >= n):
                break
            if abs(ranges[i % n] - depth) < tolerance:
                steps[side], misses = k, 0
            else:
                misses += 1
                if misses > 1:
                    break
        beyond = np.array([ranges[(around + way * (steps[side] + k)) % n] for k in (1, 2, 3)])
        opens[side] = np.median(beyond) > depth
    return steps[0], steps[1], opens[0], opens[1]
