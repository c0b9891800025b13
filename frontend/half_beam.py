"""The half-beam of a sonar, estimated from its own readings: how wide the arcs are that walls answer with.

A wall met squarely at distance d answers d over the whole beam, and beyond the half-beam h it rises as d/cos(ψ − h)
with the angle ψ from its normal (regions of constant depth, Leonard & Durrant-Whyte 1992, §4). Fitting that law to an
arc and both its flanks gives h whatever the bearing of the wall; poles and corners do not rise like it and drop out.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from frontend.scan import Floats, Integers, Scan, Sensor

FLANK = np.radians(30.0)  # of the wall beyond the arc that is fitted: as far as walls of rooms run
LEAST_FLANK = np.radians(10.0)  # on each side: less rise tells no half-beam from another
STEPS = 12  # of the fit; it settles in five
MOST_GROUPS = 8  # distances at which a half-beam is told


@dataclass(frozen=True)
class HalfBeamSettings:
    """Opinions of the estimate."""

    roughness: float = 2.0  # rms of the fit in units of the noise; larger takes arcs that are no clean wall
    surest: float = np.radians(1.5)  # standard deviation of one arc's half-beam at most; larger takes vaguer arcs
    least_arcs: int = 3  # larger asks for longer recordings
    caution: float = 1.0  # robust standard deviations below the middle of the arcs; larger claims less


@dataclass(frozen=True, eq=False)
class BeamArcs:
    """Clean arcs of walls (k,): distances in metres, half-beams in radians and their standard deviations."""

    distances: Floats
    half_beams: Floats
    spread: Floats


def beam_arcs(scans: Iterable[Scan], settings: HalfBeamSettings) -> BeamArcs:
    """What each clean arc of the scans says of the half-beam."""
    rows = [row for scan in scans for row in _arcs_of(scan, settings)]
    found = np.array(rows).reshape(-1, 3)
    return BeamArcs(found[:, 0], found[:, 1], found[:, 2])


def with_estimated_beam(sensor: Sensor, arcs: BeamArcs, settings: HalfBeamSettings) -> Sensor | None:
    """The sensor with the half-beam that the arcs vouch for, range by range; None where they are too few.

    The middle of the arcs of like distance, less how much they differ: what is no rough wall answers over less. A beam
    never widens with the range, and beyond the farthest arcs nothing is heard off the axis for sure.
    """
    if arcs.distances.size < settings.least_arcs:
        return None
    order = np.argsort(arcs.distances)
    groups = np.array_split(order, max(1, min(order.size // (2 * settings.least_arcs), MOST_GROUPS)))
    metres = np.array([np.mean(arcs.distances[group]) for group in groups])
    middle = np.array([np.median(arcs.half_beams[group]) for group in groups])
    differ = [np.median(np.abs(arcs.half_beams[g] - m)) for g, m in zip(groups, middle, strict=True)]
    formal = [np.median(arcs.spread[group]) for group in groups]
    doubt = settings.caution * np.hypot(1.4826 * np.array(differ), formal)
    # Each is a bound from below, and what is heard far away is heard nearer too.
    half_beams = np.maximum.accumulate((middle - doubt)[::-1])[::-1]
    sure = half_beams > 0
    if not sure.any():
        return None
    metres, half_beams = metres[sure], half_beams[sure]
    rows = tuple(zip(metres.tolist(), half_beams.tolist(), strict=True))
    return replace(sensor, half_beam=float(half_beams[-1]), half_beams=rows)


def _arcs_of(scan: Scan, settings: HalfBeamSettings) -> list[tuple[float, float, float]]:
    noise = float(np.hypot(scan.sensor.range_noise, scan.sensor.quantum))
    ranges = np.where(scan.ranges < scan.sensor.max_range, scan.ranges, np.inf)
    # So near that the beam narrows by much along the flank, the law does not hold.
    ranges = np.where(ranges > 2 * scan.sensor.min_range + 3 * noise, ranges, np.inf)
    found = []
    for first, last in _level_runs(ranges, noise, scan.full_turn):
        window = _flanked(ranges, first, last, noise, scan)
        if window is not None:
            bearings = np.unwrap(scan.bearings[window % ranges.size])
            inside = (window >= first) & (window <= last)
            arc = _fitted(bearings, ranges[window % ranges.size], bearings[inside], noise)
            if arc is not None and arc[2] <= settings.surest and arc[3] <= settings.roughness * noise:
                found.append(arc[:3])
    return found


def _level_runs(ranges: Floats, noise: float, full_turn: bool) -> list[tuple[int, int]]:
    """First and last reading of each run that is level to the noise and lower than what lies beside it."""
    n = ranges.size
    low = np.flatnonzero(np.isfinite(ranges))
    runs: list[tuple[int, int]] = []
    taken = np.zeros(n, dtype=bool)
    for seed in low[np.argsort(ranges[low])]:
        if taken[seed]:
            continue
        first = last = int(seed)
        while last - first < n and abs(ranges[(last + 1) % n] - ranges[seed]) <= 4 * noise:
            last += 1
        while last - first < n and abs(ranges[(first - 1) % n] - ranges[seed]) <= 4 * noise:
            first -= 1
        taken[np.arange(first, last + 1) % n] = True
        whole = full_turn or (first >= 0 and last < n)
        if whole and last - first < n // 2 and min(ranges[(first - 1) % n], ranges[(last + 1) % n]) > ranges[seed]:
            runs.append((first, last))
    return runs


def _flanked(ranges: Floats, first: int, last: int, noise: float, scan: Scan) -> Integers | None:
    """The run and its flanks as indices (w,) that may pass the ends of a turn; None where a flank is too short."""
    n, step = ranges.size, float(np.median(np.diff(scan.bearings)))
    most, least = int(FLANK / step), int(np.ceil(LEAST_FLANK / step))
    right, left = (_climb(ranges, start, sense, most, noise) for start, sense in ((first, -1), (last, 1)))
    ends = first - right, last + left
    if min(right, left) < least or (not scan.full_turn and not (ends[0] >= 0 and ends[1] < n)):
        return None
    return np.arange(ends[0], ends[1] + 1)


def _climb(ranges: Floats, start: int, sense: int, most: int, noise: float) -> int:
    """How many readings outward from `start` the wall rises without a break."""
    n, steps = ranges.size, 0
    while steps < most:
        here, there = ranges[(start + sense * steps) % n], ranges[(start + sense * (steps + 1)) % n]
        if not -4 * noise <= there - here <= 4 * noise + 0.08 * here:  # a wall 60° off its normal rises 4 % a degree
            break
        steps += 1
    return steps


def _fitted(bearings: Floats, ranges: Floats, level: Floats, noise: float) -> tuple[float, float, float, float] | None:
    """Distance, half-beam, its standard deviation and the rms of the law fitted to an arc and its flanks (w,)."""
    state = np.array([np.mean(level), np.min(ranges), max(0.5 * np.ptp(level) - np.radians(5.0), 0.0)])
    slopes, misses = np.empty((0, 3)), np.empty(0)
    for _ in range(STEPS):
        off = bearings - state[0]
        rise = np.clip(np.abs(off) - state[2], 0.0, np.radians(80.0))
        predicted = state[1] / np.cos(rise)
        steep = predicted * np.tan(rise)
        slopes = np.column_stack([-np.sign(off) * steep, 1 / np.cos(rise), -steep])
        misses = ranges - predicted
        change, *_ = np.linalg.lstsq(slopes, misses, rcond=None)
        state = state + np.clip(change, -0.1, 0.1)
    rms = float(np.sqrt(np.mean(misses**2)))
    information = slopes.T @ slopes / max(noise, rms) ** 2
    if state[2] < 0 or state[1] <= 0 or np.linalg.cond(information) > 1e12:
        return None
    return float(state[1]), float(state[2]), float(np.sqrt(np.linalg.inv(information)[2, 2])), rms
