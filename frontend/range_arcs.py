"""Range arcs: what each region of constant depth of a sonar scan says of the nearest surface behind it.

A wide beam hears the nearest thing inside it first. That thing is the foot of a wall's normal or a convex edge: either
answers at one exact range over the whole beam (regions of constant depth, Leonard & Durrant-Whyte 1992, §4). The range
is known to a reading's noise, the bearing only from where the region ends and from how the wall rises beside it; from
one place the two cannot always be told apart, so an arc carries what it says of both.
"""

from dataclasses import dataclass

import numpy as np

from frontend.arc_fit import fit_wall, level, read_as_wall, turned, wall_ranges
from frontend.compiled import compiled
from frontend.scan import Booleans, Floats, Integers, Scan


@dataclass(frozen=True)
class ArcSettings:
    """How arcs are read; the figures about the beam hold for echoes that scatter, whose strength is speckled."""

    jitter: float = np.radians(2.5)  # by which speckle moves the beam's edge; larger joins rougher rises to a wall
    gate: float = 3.0  # in sigmas; larger keeps readings farther from their wall
    misses: int = 2  # readings in a row off the wall that end it; larger bridges gaps
    least: int = 6  # readings that make an arc; larger refuses narrow gaps and far walls
    fresh: float = 0.5  # share of an arc's readings that no better arc explains; larger keeps fewer arcs
    strength: tuple[float, float] = (1.04, 0.1)  # half-beam over the stated one, and its spread from wall to wall
    edge: float = 0.9  # half-beam of an edge over the stated one: two faces that turn away answer less than one wall
    edge_spread: float = 0.2  # of it
    wall_doubt: float = np.radians(1.0)  # of a wall's direction at least: readings share their speckle
    wall_factor: float = 1.5  # of its formal spread, for the same reason
    widest: float = np.radians(12.0)  # spread of a direction that is not known at all
    firm: float = np.radians(10.0)  # a wall that rises beyond its region this far on both sides is one surely
    rising: float = np.radians(15.0)  # and on one side this far: it may be one


@dataclass(frozen=True, eq=False)
class RangeArcs:
    """Arcs of one scan (k,), bearings and lengths in the sensor's frame, and what a wall or an edge there would be.

    ranges: of the nearest surface, spread: of one of them. wall_bearings, wall_spreads: of the wall's normal;
    starts, stops: what was seen of the wall, metres leftward of its foot. edge_bearings, edge_spreads: of the edge.
    firm: surely a wall. rising: may be a wall. readings: how many hold each.
    """

    ranges: Floats
    spread: float
    wall_bearings: Floats
    wall_spreads: Floats
    starts: Floats
    stops: Floats
    edge_bearings: Floats
    edge_spreads: Floats
    firm: Booleans
    rising: Booleans
    readings: Integers


# What is kept of an arc, in the order of its row.
_ROW = (
    "range", "bearing", "strength", "formal", "readings", "first", "last",
    "flat from", "flat to", "opens right", "opens left", "half-beam", "start", "stop",
)  # fmt: skip


def range_arcs(scan: Scan, settings: ArcSettings) -> RangeArcs:
    """The arcs of a scan taken with a wide beam, those that explain most readings first."""
    sensor = scan.sensor
    beam = np.ascontiguousarray(sensor.beam)
    farthest = float(beam[-1, 0]) if np.isfinite(beam[-1, 0]) else sensor.max_range
    noise = np.array([max(sensor.range_noise, sensor.quantum), settings.jitter, settings.gate, settings.misses])
    ranges = np.where(np.isfinite(scan.ranges), scan.ranges, 10 * sensor.max_range)
    limits = np.array([settings.least, settings.fresh, farthest, sensor.min_range])
    rows = _arcs(scan.bearings, ranges, beam, noise, np.array(settings.strength), limits, scan.full_turn)
    column = dict(zip(_ROW, rows.T, strict=True))
    right, left = -column["first"] - column["half-beam"], column["last"] - column["half-beam"]
    edges, edge_spreads = _edges(column, beam, settings)
    doubt = np.hypot(settings.wall_factor * column["formal"], settings.wall_doubt)
    return RangeArcs(
        ranges=column["range"],
        spread=float(noise[0]),
        wall_bearings=column["bearing"],
        wall_spreads=np.minimum(doubt, settings.widest),
        starts=column["start"],
        stops=column["stop"],
        edge_bearings=np.mod(edges + np.pi, 2 * np.pi) - np.pi,
        edge_spreads=edge_spreads,
        firm=np.minimum(right, left) > settings.firm,
        rising=np.maximum(right, left) > settings.rising,
        readings=column["readings"].astype(np.int64),
    )


def _edges(column: dict[str, Floats], beam: Floats, settings: ArcSettings) -> tuple[Floats, Floats]:
    """Bearings (k,) and spreads (k,) of the edges that the arcs may be: a half-beam inside the ends that open."""
    half = settings.edge * np.interp(column["range"], beam[:, 0], beam[:, 1])
    first, last = column["flat from"], column["flat to"]
    right, left = column["opens right"] > 0, column["opens left"] > 0
    middle = (first + last) / 2
    bearings = np.select([right & left, right, left], [middle, first + half, last - half], middle)
    spreads = np.select(
        [right & left, right | left],
        [settings.edge_spread / np.sqrt(2) * half, settings.edge_spread * half],
        np.maximum((last - first) / 2, half / 2),
    )
    return np.asarray(bearings), np.maximum(spreads, 1.5 * settings.wall_doubt)


@compiled
def _arcs(
    bearings: Floats, ranges: Floats, beam: Floats, noise: Floats, strength: Floats, limits: Floats, cyclic: bool
) -> Floats:
    """Rows (k, 14) of arcs. limits: least readings, least fresh share, farthest and nearest range."""
    n = len(bearings)
    guesses, counts = np.empty(n), np.zeros(n, np.int64)
    for i in range(n):
        guesses[i] = np.median(np.array([ranges[(i + k) % n] for k in range(-3, 4)]))
        if limits[3] <= guesses[i] <= limits[2]:
            wall = np.array([guesses[i], bearings[i], strength[0]])
            counts[i] = read_as_wall(bearings, ranges, wall, beam, noise, i, cyclic)[0].sum()
    free = np.ones(n, np.bool_)
    rows = np.empty((n, 14))
    found = 0
    for i in np.argsort(-counts, kind="mergesort"):
        if counts[i] < limits[0] - 1 or not free[i]:
            continue
        start = np.array([guesses[i], bearings[i], strength[0]])
        wall, information, held = fit_wall(bearings, ranges, start, beam, noise, strength, i, cyclic)
        fresh = (held & free).sum()
        if wall[0] < limits[3] or fresh < max(limits[0], limits[1] * held.sum()):
            free[i] = False
            continue
        rows[found] = _row(bearings, ranges, wall, information, held, beam, noise, i, cyclic)
        free &= ~held
        found += 1
    return rows[:found].copy()


@compiled
def _row(
    bearings: Floats, ranges: Floats, wall: Floats, information: Floats, held: Booleans, beam: Floats, noise: Floats,
    around: int, cyclic: bool,
) -> Floats:  # fmt: skip
    first, last = np.inf, -np.inf
    nearest, centre = np.inf, around
    for i in np.flatnonzero(held):
        aside = turned(bearings[i] - wall[1])
        first, last = min(first, aside), max(last, aside)
        if abs(aside) < nearest:
            nearest, centre = abs(aside), int(i)
    half = wall[2] * np.interp(wall[0], beam[:, 0].copy(), beam[:, 1].copy())
    ends = wall_ranges(np.array([first, last]), wall, beam)
    extent = np.sqrt(np.maximum(ends**2 - wall[0] ** 2, 0.0))
    extent = np.where(np.isfinite(extent), extent, 0.0)
    right, left, opens_right, opens_left = level(ranges, wall[0], noise[2] * 1.15 * noise[0], centre, cyclic)
    step = (bearings[-1] - bearings[0]) / (len(bearings) - 1)
    formal = np.sqrt(np.linalg.inv(information)[1, 1])
    return np.array([
        wall[0], turned(wall[1]), wall[2], formal, float(held.sum()), first, last,
        bearings[centre] - (right + 0.5) * step, bearings[centre] + (left + 0.5) * step,
        1.0 if opens_right else 0.0, 1.0 if opens_left else 0.0, half, -extent[0], extent[1],
    ])  # fmt: skip
