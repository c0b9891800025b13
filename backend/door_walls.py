"""Walls beside doors: whether an opening interrupts a wall and leads through it, and where in the wall it lies."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon
from shapely.geometry.base import BaseGeometry

from backend.contours import as_polygons

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class DoorWallSettings:
    """Opinions about the walls beside doors; metres."""

    beside: float = 0.20  # larger lets a reported jamb lie farther off the wall it ends, and asks for a longer one
    skew: float = 0.35  # radians; larger takes gaps that stand more aslant to their walls for doors
    through: float = 0.30  # larger asks for deeper free ground on both sides of the opening
    wall: float = 0.30  # larger asks for a longer wall beyond the jambs of what only few views saw
    inside: float = (
        0.10  # behind a jamb, where its wall is measured across; larger passes rounder ends, misses short walls
    )
    turned: float = 0.80  # radians; larger looks for the wall of a door in more directions when a jamb is in the air


def leads_through(free: MultiPolygon, jambs: Floats, settings: DoorWallSettings) -> NDArray[np.bool_]:
    """Whether the ground is free, for the most part, before and behind the middles of openings (o, 2, 2)."""
    across = jambs[:, 1] - jambs[:, 0]
    normal = np.stack([-across[:, 1], across[:, 0]], axis=1) / np.linalg.norm(across, axis=1, keepdims=True)
    steps = np.linspace(0.0, settings.through, 9)[1:]
    both = np.stack([steps, -steps])[None, :, :, None] * normal[:, None, None] + jambs.mean(axis=1)[:, None, None]
    shapely.prepare(free)
    return np.asarray(np.mean(shapely.contains_xy(free, both[..., 0], both[..., 1]), axis=2).min(axis=1) >= 0.75)


def wall_beyond(edges: Floats, openings: Floats, settings: DoorWallSettings) -> Floats:
    """Metres (o,) of edge (e, 2, 2), within a metre, that run on from the first jambs away from the second ones."""
    outward = openings[:, 0] - openings[:, 1]
    outward = outward / np.linalg.norm(outward, axis=1, keepdims=True)
    arm = edges[None] - openings[:, None, None, 0]
    along = np.clip(np.sum(arm * outward[:, None, None], axis=3), 0.0, 1.0)
    aside = arm[..., 0] * outward[:, None, None, 1] - arm[..., 1] * outward[:, None, None, 0]
    length = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    parallel = np.abs(np.diff(aside, axis=2))[..., 0] <= np.sin(settings.skew) * length
    near = np.abs(aside).max(axis=2) <= settings.beside
    return np.asarray(np.sum(np.ptp(along, axis=2), axis=1, where=parallel & near))


def edges_of(free: BaseGeometry) -> Floats:
    """All edges (e, 2, 2) of the free space."""
    rings = [ring for part in as_polygons(free).geoms for ring in (part.exterior, *part.interiors)]
    corners = [np.asarray(ring.coords) for ring in rings]
    return np.concatenate([np.empty((0, 2, 2)), *(np.stack([ring[:-1], ring[1:]], axis=1) for ring in corners)])


def goes_on(edges: Floats, openings: Floats, settings: DoorWallSettings) -> NDArray[np.bool_]:
    """Openings (o, 2, 2) beside whose first jamb an edge (e, 2, 2) runs on in their line, away from the second."""
    outward = openings[:, 0] - openings[:, 1]
    outward = outward / np.linalg.norm(outward, axis=1, keepdims=True)
    along = edges[:, 1] - edges[:, 0]
    slope = np.abs(outward[:, None, 0] * along[None, :, 1] - outward[:, None, 1] * along[None, :, 0])
    parallel = slope <= np.sin(settings.skew) * np.linalg.norm(along, axis=1)
    on = np.max(np.sum((edges[None] - openings[:, None, None, 0]) * outward[:, None, None], axis=3), axis=2)
    lines, jambs = shapely.linestrings(edges[None]), shapely.points(openings[:, :1])
    near = shapely.distance(jambs, lines) <= settings.beside
    return np.asarray((parallel & near & (on >= settings.beside)).any(axis=1))


def on_the_wall(free: MultiPolygon, jambs: Floats, widths: tuple[float, float], settings: DoorWallSettings) -> Floats:
    """Jambs (2, 2) of one opening, one of which may hang in free ground: a wide beam read short beside a corner.

    The wall that goes on from the other jamb tells where it is: straight across from there. widths: least and most.
    """
    ends = shapely.points(jambs)
    hanging = np.asarray(shapely.contains(free, ends) & (shapely.distance(free.boundary, ends) > settings.beside))
    if np.count_nonzero(hanging) != 1:
        return jambs
    firm, loose = jambs[~hanging][0], jambs[hanging][0]
    along = _wall_from(edges_of(free), firm, loose, settings)
    hits = free.boundary.intersection(shapely.LineString([firm, firm + widths[1] * along]))
    across = (shapely.get_coordinates(hits) - firm) @ along
    across = across[across >= widths[0]]
    if not across.size:
        return jambs
    return np.where(hanging[:, None], firm + across.min() * along, jambs)


def _wall_from(edges: Floats, firm: Floats, loose: Floats, settings: DoorWallSettings) -> Floats:
    """Unit vector (2,) from a firm jamb across the opening, along the wall that ends there; towards the loose one
    where there is no such wall."""
    towards = (loose - firm) / np.linalg.norm(loose - firm)
    along = edges[:, 1] - edges[:, 0]
    along = along * np.where(along @ towards < 0, -1.0, 1.0)[:, None]
    length = np.maximum(np.linalg.norm(along, axis=1), 1e-9)
    beyond = ((edges.mean(axis=1) - firm) @ towards < 0) & (along @ towards > np.cos(settings.turned) * length)
    near = shapely.distance(shapely.Point(firm), shapely.linestrings(edges)) <= settings.beside
    wall = np.sum(along[beyond & near], axis=0) if np.any(beyond & near) else towards
    return np.asarray(wall / np.linalg.norm(wall))


def in_the_middle(free: MultiPolygon, jambs: Floats, thickest: float, settings: DoorWallSettings) -> Floats:
    """Jambs (2, 2) of one opening drawn to the middle line of the walls that end there.

    A wall has two faces, and what was measured of its ends are corners of either. Where one of the walls is thicker
    than `thickest`, or was seen from one side only, nothing tells its middle, and the jambs stay.
    """
    across = (jambs[1] - jambs[0]) / np.linalg.norm(jambs[1] - jambs[0])
    middles = [
        _middle_of_wall(free, jamb + settings.inside * outward, outward, thickest)
        for jamb, outward in zip(jambs, (-across, across), strict=True)
    ]
    if middles[0] is None or middles[1] is None:
        return jambs
    line = (middles[1] - middles[0]) / np.linalg.norm(middles[1] - middles[0])
    return np.asarray(middles[0] + ((jambs - middles[0]) @ line)[:, None] * line)


def _middle_of_wall(free: MultiPolygon, point: Floats, along: Floats, thickest: float) -> Floats | None:
    """The point (2,) of a wall midway between its faces, straight across from a point in it or on a face of it."""
    side = thickest * np.array([-along[1], along[0]])
    solid = shapely.get_parts(shapely.LineString([point - side, point + side]).difference(free))
    here = shapely.Point(point)
    near = [part for part in solid if part.distance(here) < 0.25 * thickest]
    if not near:
        return None
    wall = min(near, key=here.distance)
    ends = shapely.get_coordinates(wall)
    reaches_on = np.linalg.norm(ends - point, axis=1).max() > 0.999 * thickest
    return None if reaches_on or wall.length > thickest else np.asarray(ends.mean(axis=0))
