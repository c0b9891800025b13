"""Walls beside doors: whether an opening interrupts a wall and leads through it."""

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
