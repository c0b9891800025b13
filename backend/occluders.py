"""Occluders: bodies that stand before ground nobody saw, closed behind (Flynn 1988, §4.1, Figs 11–12).

From one place the robot sees the ground to the left of a body, from another that to its right: "the robot should infer
that these areas are connected and that a small object lies in the middle of the room". On the map such a body is a
front that views saw face on, between two lines of sight that go behind it. Nobody measured its back, so it is taken to
be the front's image, turned by half a turn: that closes a round thing seen by half and a box seen by two of its sides.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon, Polygon

from backend.room_map import MapEdge, MapEdgeKind
from backend.sight import Sight

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
STEP = 0.05  # metres between points of a rim


@dataclass(frozen=True)
class OccluderSettings:
    """Opinions about bodies of which nobody saw the back."""

    ahead: float = 0.05  # metres before a rim that a view must see to see the rim; larger asks for a freer sight of it
    facing: float = 0.4  # sine between beam and rim; larger takes less of a rim for seen face on
    shortest: float = 0.15  # metres; larger lets only longer pieces part a front, and be one
    widest: float = 1.5  # metres between the ends of a front; larger closes wider bodies
    bulge: float = 0.2  # of that width, by which a front must reach out; larger guesses fewer backs
    unseen: float = 0.7  # of the body closed, that nobody may have seen free; larger closes fewer


@dataclass(frozen=True, eq=False)
class Rim:
    """One ring of the map's boundary, free on its left, in pieces: starts, ends and middles (p, 2).

    real: (p,) measured. looked_at: (p,) whether a view saw the ground before it face on.
    """

    starts: Floats
    ends: Floats
    middles: Floats
    real: Flags
    looked_at: Flags


def rims_of(free: MultiPolygon, edges: tuple[MapEdge, ...], sight: Sight, settings: OccluderSettings) -> list[Rim]:
    """The outer rings of the free space; `edges` are all of its edges, labelled."""
    if not edges:
        return []
    labels = shapely.STRtree([shapely.LineString([edge.start, edge.end]) for edge in edges])
    real = np.array([edge.kind == MapEdgeKind.REAL for edge in edges])
    rims = []
    for part in shapely.orient_polygons(free).geoms:
        corners = np.asarray(shapely.segmentize(part.exterior, STEP).coords)
        starts, ends = corners[:-1], corners[1:]
        middles = 0.5 * (starts + ends)
        nearest = labels.nearest(shapely.points(middles))
        rims.append(Rim(starts, ends, middles, real[nearest], _looked_at(starts, ends, sight, settings)))
    return rims


def _looked_at(starts: Floats, ends: Floats, sight: Sight, settings: OccluderSettings) -> Flags:
    """Pieces (p,) that some view sees face on."""
    along = ends - starts
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    before = 0.5 * (starts + ends) + settings.ahead * np.stack([-along[:, 1], along[:, 0]], axis=1)
    piece, view = sight.pairs(before)
    beam = before[piece] - sight.origins[view]
    across = along[piece, 0] * beam[:, 1] - along[piece, 1] * beam[:, 0]
    facing = np.abs(across) > settings.facing * np.linalg.norm(beam, axis=1)
    return np.isin(np.arange(len(starts)), piece[facing])


def occluders(free: MultiPolygon, rims: list[Rim], settings: OccluderSettings) -> list[Polygon]:
    """Bodies whose front was seen and whose back was not, closed, as far as nobody saw free ground in them."""
    bodies = [_completed(front, settings) for rim in rims for front in _fronts(rim, settings.shortest)]
    unseen = [(body, body.difference(free)) for body in bodies if body is not None]
    return [
        max(shapely.get_parts(rest), key=lambda part: part.area)
        for body, rest in unseen
        if rest.area >= settings.unseen * body.area
    ]


def _fronts(rim: Rim, shortest: float) -> list[Floats]:
    """Corners (k, 2) of the runs of surface seen face on, between stretches that were not."""
    length = np.linalg.norm(rim.ends - rim.starts, axis=1)
    faced = _without_short(rim.real & rim.looked_at, length, shortest)
    faced = ~_without_short(~faced, length, shortest)
    if faced.all() or not faced.any():
        return []
    return [np.vstack([rim.starts[run], rim.ends[run[-1:]]]) for run in _runs(faced)]


def _runs(flags: Flags) -> list[NDArray[np.int64]]:
    """Indices of every run of set flags around a ring; not all of them are set."""
    shift = int(np.argmin(flags))
    turned = np.roll(flags, -shift)
    ends = np.flatnonzero(np.diff(np.concatenate([[0], turned.view(np.int8), [0]])))
    return [(np.arange(a, b) + shift) % len(flags) for a, b in ends.reshape(-1, 2)]


def _without_short(flags: Flags, length: Floats, shortest: float) -> Flags:
    """The flags with runs of set ones shorter than `shortest` metres cleared."""
    kept = flags.copy()
    if not flags.all():
        for run in _runs(flags):
            kept[run] = length[run].sum() >= shortest
    return kept


def _completed(front: Floats, settings: OccluderSettings) -> Polygon | None:
    """The hull of a front (k, 2) and of its image turned by half a turn; None where it does not bulge enough."""
    chord = front[-1] - front[0]
    width = float(np.linalg.norm(chord))
    if not 1e-6 < width <= settings.widest:
        return None
    arm = front - front[0]
    out = (chord[0] * arm[:, 1] - chord[1] * arm[:, 0]) / width
    if out.max() < settings.bulge * width or out.min() < -settings.bulge * out.max():
        return None
    hull = shapely.MultiPoint(np.vstack([front, front[0] + front[-1] - front])).convex_hull
    return hull if isinstance(hull, Polygon) else None
