"""A world: a floor plan in GeoJSON metres, read into free space, named doors and the surfaces the sensors meet.

Features by `kind`: `wall` and `obstacle` (polygons; `material` rough, smooth, slatted or dark; optional `reflectance`
and, for round things, `radius`), `door` (a line between the jambs; `name`, `open`), `room` (names a region), `boundary`
(outside of it all is wall) and `drive` (a line of waypoints, see the trajectory).
"""

import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, Point, Polygon, STRtree
from shapely.errors import ShapelyError
from shapely.geometry import shape
from shapely.geometry.base import BaseGeometry

from frontend.scan import Floats
from frontend.sensors.surfaces import MATERIALS, Material, Surfaces, join_rings

LEAF = 0.04  # metres: thickness of a closed door
MARGIN = 0.2  # metres: thickness of the wall around a boundary


class PlanError(Exception):
    """A floor plan that cannot be built: the message names the file and the feature."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A body that stops the robot and answers the sensors. radius: of its curvature, infinite for flat faces."""

    kind: str
    outline: BaseGeometry
    material: str
    reflectance: float | None = None
    radius: float = float("inf")

    @property
    def made_of(self) -> Material:
        """The material, with its own reflectance where the plan gives one."""
        material = MATERIALS[self.material]
        return material if self.reflectance is None else replace(material, reflectance=self.reflectance)


@dataclass(frozen=True, eq=False)
class PlanDoor:
    """A door of the plan. jambs: (2, 2) metres."""

    name: str
    jambs: Floats
    is_open: bool


@dataclass(frozen=True, eq=False)
class Drive:
    """Waypoints (p, 2) and how the robot passes them.

    step: metres between scans, None: at the waypoints only. headings: (p,) radians, None: facing ahead.
    wheels: how they err, by the field names of the wheel noise.
    """

    waypoints: Floats
    step: float | None = None
    headings: Floats | None = None
    wheels: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class World:
    """Free space that the first waypoint can reach, what bounds it, and its doors."""

    name: str
    description: str
    solids: tuple[Solid, ...]
    doors: tuple[PlanDoor, ...]
    free: Polygon
    surfaces: Surfaces
    drive: Drive | None
    rooms: tuple[Polygon, ...]


def read_plan(path: Path) -> World:
    """The world of a plan file. Raises PlanError with the file and the feature where it cannot be."""
    try:
        plan = json.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as reason:
        raise PlanError(f"{path} cannot be read: {reason.strerror or reason}") from reason
    except ValueError as damage:
        raise PlanError(f"{path}: cannot be read as GeoJSON: {damage}") from damage
    if not isinstance(plan, dict) or not isinstance(plan.get("features"), list):
        raise PlanError(f"{path} is not a GeoJSON FeatureCollection")
    try:
        return build_world(plan)
    except PlanError as error:
        raise PlanError(f"{path}: {error}") from error


def build_world(plan: dict[str, Any]) -> World:
    """The world of a plan that is already parsed."""
    features = [_checked(index, feature) for index, feature in enumerate(plan.get("features", []))]
    of_kind = {
        kind: [feature for feature in features if feature[0] == kind]
        for kind in ("wall", "obstacle", "door", "room", "boundary", "drive")
    }
    doors = tuple(_door(geometry, properties) for _, geometry, properties in of_kind["door"])
    solids = [
        _solid(kind, geometry, properties) for kind, geometry, properties in of_kind["wall"] + of_kind["obstacle"]
    ]
    solids += [
        _leaf(geometry, properties) for _, geometry, properties in of_kind["door"] if not properties.get("open", True)
    ]
    solids += [_around(geometry, properties) for _, geometry, properties in of_kind["boundary"]]
    drive = _drive(*of_kind["drive"][0][1:]) if of_kind["drive"] else None
    free = _free_space(solids, drive)
    rooms = tuple(geometry for _, geometry, _ in of_kind["room"])
    name, description = str(plan.get("name", "")), str(plan.get("description", ""))
    return World(name, description, tuple(solids), doors, free, _surfaces(free, solids), drive, rooms)


def _checked(index: int, feature: dict[str, Any]) -> tuple[str, Any, dict[str, Any]]:
    try:
        properties = feature.get("properties") or {}
        kind = properties.get("kind")
    except AttributeError as damage:
        raise PlanError(f"feature {index} is no GeoJSON feature with properties") from damage
    expected = {"wall": "Polygon", "obstacle": "Polygon", "room": "Polygon", "boundary": "Polygon"}
    expected |= {"door": "LineString", "drive": "LineString"}
    if kind not in expected:
        raise PlanError(f"feature {index} has kind {kind!r}, known kinds are {', '.join(expected)}")
    try:
        geometry = shapely.force_2d(shape(feature["geometry"]))
    except (KeyError, TypeError, AttributeError, ValueError, ShapelyError) as damage:
        raise PlanError(f"feature {index}: the {kind} has no geometry that can be read: {damage!r}") from damage
    if geometry.geom_type != expected[kind] or not geometry.is_valid:
        raise PlanError(f"feature {index}: a {kind} must be a valid {expected[kind]}, not a {geometry.geom_type}")
    material = properties.get("material", "rough")
    if material not in MATERIALS:
        raise PlanError(f"feature {index} has material {material!r}, known materials are {', '.join(MATERIALS)}")
    return kind, geometry, properties


def _solid(kind: str, outline: BaseGeometry, properties: dict[str, Any]) -> Solid:
    radius = _above_zero(properties, "radius") or np.inf
    return Solid(kind, outline, properties.get("material", "rough"), _above_zero(properties, "reflectance"), radius)


def _leaf(opening: LineString, properties: dict[str, Any]) -> Solid:
    outline = opening.buffer(LEAF / 2, cap_style="flat")
    return Solid("door", outline, properties.get("material", "smooth"), _above_zero(properties, "reflectance"))


def _around(boundary: Polygon, properties: dict[str, Any]) -> Solid:
    return _solid("wall", boundary.buffer(MARGIN, join_style="mitre").difference(boundary), properties)


def _door(opening: LineString, properties: dict[str, Any]) -> PlanDoor:
    return PlanDoor(str(properties.get("name", "")), np.array(opening.coords), bool(properties.get("open", True)))


def _drive(line: LineString, properties: dict[str, Any]) -> Drive:
    headings = properties.get("headings")
    if isinstance(headings, list) and len(headings) != len(line.coords):
        raise PlanError(f"the drive has {len(line.coords)} waypoints, but {len(headings)} headings")
    try:
        radians = None if headings is None else np.radians(np.array(headings, float))
        wheels = {str(name): float(value) for name, value in properties.get("wheels", {}).items()}
    except (TypeError, ValueError, AttributeError) as damage:
        raise PlanError(f"the drive's headings and wheels should be numbers: {damage}") from damage
    return Drive(np.array(line.coords), _above_zero(properties, "step"), radians, wheels)


def _above_zero(properties: dict[str, Any], name: str) -> float | None:
    value = properties.get(name)
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < np.inf:
        raise PlanError(f"{name} = {value!r} should be a number above 0")
    return float(value)


def _free_space(solids: list[Solid], drive: Drive | None) -> Polygon:
    """What the drive can reach: the component of the enclosed space that holds its first waypoint, or the largest."""
    solid = shapely.union_all([body.outline for body in solids], grid_size=1e-6)
    hulls = [Polygon(part.exterior) for part in shapely.get_parts(solid)]
    enclosed: BaseGeometry = shapely.union_all(hulls).difference(solid)
    parts = [part for part in shapely.get_parts(enclosed) if isinstance(part, Polygon) and part.area > 1e-6]
    if not parts:
        raise PlanError(f"the {len(solids)} walls and obstacles enclose no free space")
    if drive is None:
        return max(parts, key=lambda part: part.area)
    start = Point(drive.waypoints[0])
    holding = [part for part in parts if part.contains(start)]
    if not holding:
        raise PlanError(f"the drive starts at {start.x:g}, {start.y:g}, which is not in the enclosed free space")
    if not holding[0].covers(LineString(drive.waypoints)):
        raise PlanError("the drive passes through a wall or an obstacle")
    return holding[0]


def _surfaces(free: Polygon, solids: list[Solid]) -> Surfaces:
    """The faces of the free space, each with the material of the solid it belongs to."""
    oriented = shapely.orient_polygons(free, exterior_cw=False)
    tree = STRtree([body.outline.boundary for body in solids])
    rings, materials, radii = [], [], []
    for line in (oriented.exterior, *oriented.interiors):
        ring = np.array(line.coords)[:-1]
        owners = [solids[index] for index in tree.nearest(shapely.points((ring + np.roll(ring, -1, axis=0)) / 2))]
        kept = _real_corners(ring, owners)
        rings.append(ring[kept])
        materials.append([owners[index].made_of for index in kept])
        radii.append(np.array([owners[index].radius for index in kept]))
    return join_rings(rings, materials, radii)


def _real_corners(ring: Floats, owners: list[Solid]) -> NDArray[np.int64]:
    """Corners of a ring (k, 2) where it turns or the material changes: a wall is one face, however drawn."""
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    turn = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], np.sum(before * after, axis=1))
    changes = [ours.made_of != theirs.made_of for ours, theirs in zip(owners, owners[-1:] + owners[:-1], strict=True)]
    return np.flatnonzero((np.abs(turn) > 1e-4) | np.array(changes))
