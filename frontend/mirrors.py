"""Mirrors: smooth walls that answer from the foot of their normal only, and what a scan knows beside them.

A smooth wall mirrors a beam that meets it aslant, so the reading tells what the mirror shows and is much too long
(Flynn 1988, §2.1, Fig. 6). A wall that scatters is heard all along: its readings rise beside the foot. A mirror is
heard from its foot alone, on one level and far wider off the axis than anything that scatters, until the beam loses it
and jumps. So about the foot there is wall, the rest of the level is no surface, and past such an end nothing is known
beyond the wall's own line.
"""

from dataclasses import dataclass

import numpy as np

from frontend.scan import Booleans, Floats, Integers, Scan


@dataclass(frozen=True)
class MirrorSettings:
    """Opinions about mirrors."""

    gate: float = 4.0  # in sigmas of a reading; larger takes only flatter runs of readings for mirrors
    late: float = 0.18  # metres; larger lets fading echoes be heard later: a chirp of 1 ms at most (Flynn 1988, §2.1)
    bright: float = 1.35  # of the stated half-beam; larger takes strong echoes that scatter for no mirrors
    lost: float = np.radians(65.0)  # off its normal, where a beam loses a smooth wall (Flynn 1988, §2.1: 25° to it)
    outer: float = np.radians(15.0)  # of a run's end; larger judges its flatness on more readings


@dataclass(frozen=True, eq=False)
class Mirror:
    """A smooth wall: bearing and range of its foot, the readings it was heard in, and where the beam lost it.

    Where it was not lost on its right or its left, something nearer hides it.
    """

    foot: float
    metres: float
    readings: Integers
    lost_right: bool
    lost_left: bool


@dataclass(frozen=True, eq=False)
class BesideMirrors:
    """What mirrors make of readings: metres (n,) up to which each can have looked, `inf` without a mirror beside it;
    wall: (n,) it met a mirror squarely, at that range; bound: (n,) it heard a mirror's foot from aside."""

    farthest: Floats
    wall: Booleans
    bound: Booleans


def beside_mirrors(scan: Scan, settings: MirrorSettings) -> BesideMirrors:
    """What the mirrors of a scan make of its readings."""
    farthest, wall, bound = np.full(scan.ranges.size, np.inf), *np.zeros((2, scan.ranges.size), dtype=np.bool_)
    for mirror in mirrors(scan, settings):
        aside = (scan.bearings - mirror.foot + np.pi) % (2 * np.pi) - np.pi
        ahead = np.abs(aside) < np.pi / 2
        heard = np.isin(np.arange(aside.size), mirror.readings)
        square = heard & (np.abs(aside) <= scan.sensor.half_beam_at(mirror.metres))
        past = ahead & np.where(aside > 0, mirror.lost_left, mirror.lost_right) | square
        farthest[past] = np.minimum(farthest[past], mirror.metres / np.cos(aside[past]))
        wall, bound = wall | square, bound | (heard & ~square)
    return BesideMirrors(farthest, wall, bound & ~wall)


def mirrors(scan: Scan, settings: MirrorSettings) -> list[Mirror]:
    """The smooth walls of a full turn of a wide beam; none where the beam is thin."""
    if scan.sensor.half_beam <= 0 or not scan.full_turn:
        return []
    ranges = np.where(np.isfinite(scan.ranges), scan.ranges, 10 * scan.sensor.max_range)
    unread, found = ranges <= scan.sensor.max_range, []
    for nearest in np.argsort(ranges, kind="stable"):
        if unread[nearest]:
            found += _mirror_at(int(nearest), ranges, unread, (scan, settings))
    return found


def _mirror_at(nearest: int, ranges: Floats, unread: Booleans, read: tuple[Scan, MirrorSettings]) -> list[Mirror]:
    """The mirror whose level holds the nearest reading left, if it is one; its readings are marked as read."""
    scan, settings = read
    n, step = ranges.size, float(np.median(np.diff(scan.bearings)))
    noise = settings.gate * float(np.hypot(scan.sensor.range_noise, scan.sensor.quantum))
    metres = float(np.median(ranges[(nearest + np.arange(-2, 3)) % n]))
    run = _run(ranges, nearest, (metres - noise, metres + settings.late))
    unread[run % n] = False
    opens, steps = (ranges[(run[[0, -1]] + [-k, k]) % n] - ranges[run[[0, -1]] % n] for k in (1, 3))
    aside = (run - nearest) * step
    if max(opens) <= 0 or (min(opens) <= 0 and aside[-1] - aside[0] < settings.lost):
        return []
    hidden = aside[0] + settings.lost if opens[0] > 0 else aside[-1] - settings.lost
    foot = (aside[0] + aside[-1]) / 2 if min(opens) > 0 else hidden
    # What scatters rises beside its foot from where the beam no longer reaches back to it.
    beam = settings.bright * scan.sensor.half_beam_at(metres)
    above = metres / np.cos(np.clip(np.abs(aside - foot) - beam, 0, settings.lost)) - ranges[run % n]
    outer = aside - aside[0] < settings.outer, aside[-1] - aside < settings.outer
    flat = np.array([float(np.median(above[part])) > noise for part in outer])
    lost = flat & (steps > settings.late)
    if not any(lost) or any((opens > 0) & ~flat):
        return []
    return [Mirror(float(scan.bearings[nearest] + foot), metres, run % n, *map(bool, lost))]


def _run(ranges: Floats, around: int, band: tuple[float, float]) -> Integers:
    """The readings about one, counted from it past the ends of the turn, that lie in a band of ranges.

    One alone outside does not end them.
    """
    n = ranges.size
    turn, middle = around + np.arange(-(n // 2), n - n // 2), n // 2
    inside = (ranges[turn % n] >= band[0]) & (ranges[turn % n] <= band[1])
    inside[middle] = True
    gaps = np.flatnonzero(~inside[:-1] & ~inside[1:])  # of two readings
    first = gaps[gaps < middle].max(initial=-2) + 2
    last = gaps[gaps >= middle].min(initial=n) - 1
    return np.asarray(turn[first : last + 1])
