"""Births: walls and edges that several arcs agree on before anything on the map explains them.

From one place an arc may be a wall or an edge. Seen from two, a wall touches both circles of range, an edge is where
they cross; a third place tells which (Leonard & Durrant-Whyte 1992, §4.3). Each pair of arcs, one of them new,
proposes; all loose arcs vote; what most agree on is born, unless the other kind explains them as well.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]


@dataclass(frozen=True)
class BirthSettings:
    """When loose arcs are one thing."""

    votes: int = 3  # scans that must agree; larger bears fewer, surer landmarks
    gate: float = 7.0  # squared distance up to which an arc agrees; larger lets more arcs vote
    margin: float = 4.0  # by which the best of the other kind must be worse; larger waits for more views
    nearest: float = 0.15  # metres between two places that propose; smaller proposes from almost the same place
    farthest: float = 4.0
    facing: float = np.radians(60.0)  # between rays that meet one edge; larger pools both corners of a wall's end
    gap: float = 0.5  # metres of a wall that nobody saw between two parts; larger joins walls across gaps
    drift: tuple[float, float] = (0.008, 0.006)  # metres of doubt between places, and per scan between them
    swing: float = 0.015  # radians of doubt between them


@dataclass(frozen=True, eq=False)
class Loose:
    """Loose arcs (m,) in the room's axes.

    owner: the pose of each, rising from old to new; places: (m, 2) of that pose. spread: metres of one range. walls,
    edges: heading of the wall's normal and of the edge, with spreads; starts, stops: of the wall, from the foot.
    """

    owner: Integers
    places: Floats
    ranges: Floats
    spread: float
    walls: Floats
    wall_spreads: Floats
    starts: Floats
    stops: Floats
    edges: Floats
    edge_spreads: Floats
    rising: Booleans


@dataclass(frozen=True, eq=False)
class Birth:
    """A landmark: members, the arcs that see it (one a scan). wall: heading and distance of the line, else x and y."""

    wall: bool
    values: Floats
    members: Integers


@dataclass(frozen=True, eq=False)
class _Doubts:
    """What poses add to the spread of each arc (m,): metres and radians; turn: of the newest pose."""

    metres: Floats
    radians: Floats
    turn: float


def births(loose: Loose, newest: int, turn: float, settings: BirthSettings) -> Iterator[Birth]:
    """Landmarks with a member from the pose `newest`, the surest first. turn: radians its heading is in doubt."""
    doubts = _doubts(loose, newest, turn, settings)
    proposals = _walls(loose, newest, doubts, settings) + _edges(loose, newest, doubts, settings)
    free = np.ones(len(loose.owner), np.bool_)
    while True:
        candidates = [
            (score, wall, values, members)
            for wall, values in proposals
            for score, members in [_votes(loose, wall, values, free, doubts, settings)]
            if len(members) >= settings.votes and loose.owner[members[-1]] == newest
        ]
        if not candidates:
            return
        score, wall, values, members = max(candidates, key=lambda candidate: candidate[0])
        rivals = [
            other for other, kind, _, seen in candidates if kind != wall and len(np.intersect1d(seen, members)) > 1
        ]
        if rivals and max(rivals) > score - settings.margin:
            free[members[loose.owner[members] == newest]] = False  # undecided: a later place will tell
        else:
            free[members] = False
            yield Birth(wall, values, members)


def _doubts(loose: Loose, newest: int, turn: float, settings: BirthSettings) -> _Doubts:
    own = loose.owner == newest
    metres = settings.drift[0] + settings.drift[1] * np.abs(newest - loose.owner)
    return _Doubts(metres, np.where(own, np.hypot(settings.swing, turn), settings.swing), turn)


def _pairs(loose: Loose, newest: int, settings: BirthSettings) -> tuple[Integers, Integers, Floats, Floats]:
    """New and older arcs (p,) that may propose together, the way between their places, and its length (p,)."""
    new, old = np.nonzero((loose.owner == newest)[:, None] & (loose.owner < newest)[None])
    ways = loose.places[old] - loose.places[new]
    lengths = np.linalg.norm(ways, axis=1)
    kept = (lengths > settings.nearest) & (lengths < settings.farthest)
    return new[kept], old[kept], ways[kept], lengths[kept]


def _walls(loose: Loose, newest: int, doubts: _Doubts, settings: BirthSettings) -> list[tuple[bool, Floats]]:
    """Lines (heading, distance) that touch the circles of two arcs on one side."""
    new, old, ways, lengths = _pairs(loose, newest, settings)
    share = (loose.ranges[new] - loose.ranges[old]) / lengths
    aside = np.arccos(np.clip(share, -1, 1))
    found: list[tuple[bool, Floats]] = []
    for side in (1, -1):
        headings = _wrapped(np.arctan2(ways[:, 1], ways[:, 0]) + side * aside)
        kept = np.abs(share) <= 1.05
        for arcs in (new, old):
            kept &= np.abs(_wrapped(headings - loose.walls[arcs])) < 3 * np.hypot(loose.wall_spreads[arcs], doubts.turn)
        normals = np.column_stack([np.cos(headings), np.sin(headings)])
        distances = np.sum(normals * loose.places[new], axis=1) + loose.ranges[new]
        found += [(True, np.array(line)) for line in zip(headings[kept], distances[kept], strict=True)]
    return found


def _edges(loose: Loose, newest: int, doubts: _Doubts, settings: BirthSettings) -> list[tuple[bool, Floats]]:
    """Places (2,) where the circles of two arcs cross."""
    new, old, ways, lengths = _pairs(loose, newest, settings)
    first, second = loose.ranges[new], loose.ranges[old]
    along = (lengths**2 + first**2 - second**2) / (2 * lengths)
    square = first**2 - along**2
    ahead, across = ways / lengths[:, None], np.column_stack([-ways[:, 1], ways[:, 0]]) / lengths[:, None]
    found: list[tuple[bool, Floats]] = []
    for side in (1, -1):
        aside = side * np.sqrt(np.maximum(square, 0))
        places = loose.places[new] + along[:, None] * ahead + aside[:, None] * across
        kept = square > -0.03 * first
        for arcs in (new, old):
            rays = places - loose.places[arcs]
            off = _wrapped(np.arctan2(rays[:, 1], rays[:, 0]) - loose.edges[arcs])
            kept &= np.abs(off) < 3 * np.hypot(loose.edge_spreads[arcs], doubts.turn)
        found += [(False, place) for place in places[kept]]
    return found


def _votes(
    loose: Loose, wall: bool, values: Floats, free: Booleans, doubts: _Doubts, settings: BirthSettings
) -> tuple[float, Integers]:
    """How well loose arcs agree on a landmark, and the best of each scan that do (v,)."""
    if wall:
        normal = np.array([np.cos(values[0]), np.sin(values[0])])
        gaps = values[1] - loose.places @ normal - loose.ranges
        turns, spreads = _wrapped(values[0] - loose.walls), loose.wall_spreads
    else:
        rays = values - loose.places
        gaps = np.hypot(rays[:, 0], rays[:, 1]) - loose.ranges
        headings = np.arctan2(rays[:, 1], rays[:, 0])
        turns, spreads = _wrapped(headings - loose.edges), loose.edge_spreads
        # A wall's end has two corners: what is met from the other side is not the same.
        free = free & (np.abs(_wrapped(headings - headings[-1])) < settings.facing)
    squares = (gaps / np.hypot(loose.spread, doubts.metres)) ** 2 + (turns / np.hypot(spreads, doubts.radians)) ** 2
    agreeing = np.flatnonzero((squares < settings.gate) & free)
    order = agreeing[np.lexsort((squares[agreeing], loose.owner[agreeing]))]
    members = order[np.unique(loose.owner[order], return_index=True)[1]]
    if wall and not (loose.rising[members].any() and _joined(loose, values[0], members, settings)):
        members = members[:0]
    return float(settings.gate * len(members) - squares[members].sum()), members


def _joined(loose: Loose, heading: float, members: Integers, settings: BirthSettings) -> bool:
    """Whether what the arcs saw of a wall leaves no gap wider than the setting."""
    feet = loose.places[members] @ np.array([-np.sin(heading), np.cos(heading)])
    order = np.argsort(feet + loose.starts[members])
    starts, stops = (feet + loose.starts[members])[order], (feet + loose.stops[members])[order]
    return bool(np.all(starts[1:] <= np.maximum.accumulate(stops)[:-1] + settings.gap))


def _wrapped(angles: Floats) -> Floats:
    return np.asarray((angles + np.pi) % (2 * np.pi) - np.pi)
