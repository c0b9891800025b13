"""Doors: openings between two jambs, from the infrared's edges and from facing jambs of the fused map.

A jamb of the map is the tip of a thin wall: seen along the line to its partner the wall recedes on both
sides, and a little way inside, the wall is no thicker than walls are.
"""

from dataclasses import dataclass, field, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely import MultiPolygon

from backend.contours import as_polygons
from backend.door_walls import (
    DoorWallSettings,
    edges_of,
    goes_on,
    in_the_middle,
    leads_through,
    on_the_wall,
    wall_beyond,
)
from backend.room_map import Door
from backend.sight import Sight

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class DoorSettings:
    """Opinions about doors, in metres."""

    narrowest: float = 0.55  # larger misses narrow doors
    widest: float = 1.40  # larger takes passages for doors
    thickest: float = 0.40  # of the wall; larger takes the gaps between furniture for doors
    detail: float = 0.03  # larger ignores bigger bumps of the boundary when looking for jambs
    apart: float = 0.40  # larger joins more distant sightings into one door
    many: int = 5  # views; larger asks more openings for walls: few views see a chance gap between things as a door
    walls: DoorWallSettings = field(default_factory=DoorWallSettings)


@dataclass(frozen=True, eq=False)
class Opening:
    """Sightings of openings: jambs (o, 2, 2), and of each a weight (o,), a whole number.

    view: (o,) that reported it, −1 for the fused map.
    """

    jambs: Floats
    weight: Floats
    view: Ints


def doors_of(
    free: MultiPolygon, walls: MultiPolygon, reported: Opening, sight: Sight, settings: DoorSettings
) -> tuple[Door, ...]:
    """Named doors, left to right: openings the views reported, and facing jambs of the free space between walls.

    `walls` is the free space with the objects in it filled, so that gaps between furniture are no doors.
    """
    facing, reported = facing_jambs(walls, settings), _in_line(free, _door_wide(reported, settings), settings)
    seen = Opening(
        np.concatenate([facing.jambs, reported.jambs]),
        np.concatenate([facing.weight, reported.weight]),
        np.concatenate([facing.view, reported.view]),
    )
    merged = [_merged(seen, group, sight) for group in _grouped(seen.jambs, settings.apart)]
    widths = settings.narrowest, settings.widest
    merged = [replace(door, jambs=on_the_wall(free, door.jambs, widths, settings.walls)) for door in merged]
    merged = [
        replace(door, jambs=in_the_middle(walls, door.jambs, settings.thickest, settings.walls)) for door in merged
    ]
    merged = [door for door, stays in zip(merged, _are_doors(free, merged, settings), strict=True) if stays]
    merged.sort(key=lambda door: tuple(door.jambs.mean(axis=0)))
    return tuple(Door(f"door {i + 1}", door.jambs, door.sure, door.views) for i, door in enumerate(merged))


def _are_doors(free: MultiPolygon, merged: list["_Merged"], settings: DoorSettings) -> NDArray[np.bool_]:
    """Which openings lead through and interrupt a wall, on both sides of what few views and no jambs of the map tell.

    A gap between two things, or between a thing and a wall, looks like a door from few places only.
    """
    jambs = np.array([door.jambs for door in merged]).reshape(-1, 2, 2)
    edges = edges_of(free)
    walled = (
        np.array([wall_beyond(edges, jambs[:, [end, 1 - end]], settings.walls) for end in (0, 1)]) > settings.walls.wall
    )
    many = np.array([door.sightings >= settings.many for door in merged], dtype=np.bool_)
    facing = np.array([door.facing for door in merged], dtype=np.bool_)
    return leads_through(free, jambs, settings.walls) & (many | walled.all(axis=0) | (facing & walled.any(axis=0)))


def _door_wide(reported: Opening, settings: DoorSettings) -> Opening:
    """The reported openings that are as wide as a door."""
    width = np.linalg.norm(reported.jambs[:, 1] - reported.jambs[:, 0], axis=1)
    fits = (width >= settings.narrowest) & (width <= settings.widest)
    return Opening(reported.jambs[fits], reported.weight[fits], reported.view[fits])


def _in_line(free: MultiPolygon, reported: Opening, settings: DoorSettings) -> Opening:
    """The reported openings in whose line a wall of the map goes on from a jamb: the others are gaps between things."""
    edges = edges_of(free.simplify(settings.detail))
    walled = np.zeros(len(reported.weight), dtype=np.bool_)
    for end in (0, 1):
        walled |= goes_on(edges, reported.jambs[:, [end, 1 - end]], settings.walls)
    return Opening(reported.jambs[walled], reported.weight[walled], reported.view[walled])


def facing_jambs(free: MultiPolygon, settings: DoorSettings) -> Opening:
    """Pairs of wall tips of the free space that face each other across a gap as wide as a door."""
    outline = as_polygons(free.simplify(settings.detail))
    tips, before, after = _tips(outline)
    none = Opening(np.empty((0, 2, 2)), np.empty(0), np.empty(0, dtype=np.int64))
    if len(tips) < 2:
        return none
    pairs = cKDTree(tips).query_pairs(settings.widest, output_type="ndarray")
    gap = tips[pairs[:, 1]] - tips[pairs[:, 0]]
    pairs = pairs[np.linalg.norm(gap, axis=1) > settings.narrowest]
    for one, other in ((0, 1), (1, 0)):
        pairs = pairs[_recedes(tips, before, after, pairs[:, [one, other]])]
    across = tips[pairs]
    shapely.prepare(outline)
    shrunk = across + 0.02 * (across[:, ::-1] - across) / np.linalg.norm(
        across[:, ::-1] - across, axis=2, keepdims=True
    )
    across = across[shapely.covers(outline, shapely.linestrings(shrunk))] if len(across) else across
    for end in (0, 1):
        across = across[_thin(outline, across[:, [end, 1 - end]], settings)] if len(across) else across
    return Opening(across, np.full(len(across), 2.0), np.full(len(across), -1)) if len(across) else none


def _tips(free: MultiPolygon) -> tuple[Floats, Floats, Floats]:
    """Corners (t, 2) that stick into the free space, with the corners before and after them along the boundary."""
    tips, before, after = [np.empty((0, 2))], [np.empty((0, 2))], [np.empty((0, 2))]
    for part in shapely.get_parts(free):
        whole = shapely.orient_polygons(part)
        for ring in (whole.exterior, *whole.interiors):
            corner = np.asarray(ring.coords)[:-1]
            last, following = np.roll(corner, 1, axis=0), np.roll(corner, -1, axis=0)
            incoming, outgoing = corner - last, following - corner
            turns_right = incoming[:, 0] * outgoing[:, 1] - incoming[:, 1] * outgoing[:, 0] < 0
            for kept, points in ((tips, corner), (before, last), (after, following)):
                kept.append(points[turns_right])
    return np.concatenate(tips), np.concatenate(before), np.concatenate(after)


def _recedes(tips: Floats, before: Floats, after: Floats, pairs: Ints) -> NDArray[np.bool_]:
    """Pairs (p,) at whose first tip the boundary leads away from the second, to 20° at most."""
    across = tips[pairs[:, 1]] - tips[pairs[:, 0]]
    across = across / np.linalg.norm(across, axis=1, keepdims=True)
    slack = np.sin(np.radians(20))
    away = [points[pairs[:, 0]] - tips[pairs[:, 0]] for points in (before, after)]
    return np.asarray(np.all([np.sum(a * across, axis=1) <= slack * np.linalg.norm(a, axis=1) for a in away], axis=0))


def _thin(free: MultiPolygon, across: Floats, settings: DoorSettings) -> NDArray[np.bool_]:
    """Pairs (p, 2, 2) whose first jamb is the tip of a wall: 10 cm inside it, free ground lies close on both sides."""
    towards = across[:, 1] - across[:, 0]
    towards = towards / np.linalg.norm(towards, axis=1, keepdims=True)
    side = np.stack([-towards[:, 1], towards[:, 0]], axis=1)
    steps = np.linspace(-settings.thickest, settings.thickest, 33)
    line = (across[:, 0] - 0.10 * towards)[:, None] + steps[None, :, None] * side[:, None]
    blocked = ~shapely.contains_xy(free, line[..., 0], line[..., 1])
    left, right = _reach(blocked[:, :17][:, ::-1]), _reach(blocked[:, 16:])
    step = steps[1] - steps[0]
    wall = (left + right) * step
    return np.asarray((wall > 0.5 * step) & (wall <= settings.thickest) & (np.minimum(left, right) <= 3))


def _reach(blocked: NDArray[np.bool_]) -> Ints:
    """How many steps from the tip outward the line stays blocked, a first free stretch of three steps forgiven."""
    steps = np.arange(blocked.shape[1])
    started = np.where((steps < 4) & blocked, steps, blocked.shape[1]).min(axis=1)
    beyond = (steps[None, :] > started[:, None]) & ~blocked
    end = np.where(beyond.any(axis=1), beyond.argmax(axis=1), blocked.shape[1] * 10)
    return np.where(started < blocked.shape[1], end, 0)


def _grouped(jambs: Floats, apart: float) -> list[Ints]:
    """Sightings whose middles lie within `apart` of each other, linked transitively."""
    if not len(jambs):
        return []
    middles = jambs.mean(axis=1)
    group = np.arange(len(jambs))
    for one, other in cKDTree(middles).query_pairs(apart):
        group[group == group[other]] = group[one]
    return [np.flatnonzero(group == number) for number in np.unique(group)]


def _sharpest(seen: Opening, group: Ints) -> Ints:
    """The sightings that say where the jambs of one door are: the reported ones, as the infrared that finds them is
    sharper than the wide beam it goes with; without any, the pairs of tips that span it most shortly."""
    reported = group[seen.view[group] >= 0]
    if len(reported):
        return np.asarray(reported)
    across = seen.jambs[group, 1] - seen.jambs[group, 0]
    width = np.linalg.norm(across, axis=1)
    shortest = int(np.argmin(width))
    parallel = np.abs(across @ across[shortest]) > np.cos(np.radians(10)) * width * width[shortest]
    return np.asarray(group[parallel & (width < 1.05 * width[shortest])])


@dataclass(frozen=True, eq=False)
class _Merged:
    """Sightings of one opening: its jambs (2, 2), how sure it is, the views that reported it or saw through its middle,
    how many reported it, and whether jambs of the map face each other there."""

    jambs: Floats
    sure: float
    views: Ints
    sightings: int
    facing: bool


def _merged(seen: Opening, group: Ints, sight: Sight) -> _Merged:
    sharpest = _sharpest(seen, group)
    jambs = seen.jambs[sharpest]
    turned = np.sum((jambs[:, 1] - jambs[:, 0]) * (jambs[0, 1] - jambs[0, 0]), axis=1) < 0
    middle = np.median(np.where(turned[:, None, None], jambs[:, ::-1], jambs), axis=0)
    _, through = sight.pairs(middle.mean(axis=0)[None])
    reported = seen.view[group][seen.view[group] >= 0]
    views = np.unique(np.concatenate([through, reported]))
    evidence = float(seen.weight[group].max() + len(reported) + min(len(through), 4) / 2)
    return _Merged(middle, evidence / (evidence + 1), views, len(reported), bool((seen.view[group] < 0).any()))
