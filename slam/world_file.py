"""Worlds to plan in, from files: maps of merge, floor plans, obstacles within a boundary, and thin rectangles."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from shapely import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from backend.room_map import MapEdgeKind
from frontend.scan import Floats
from planners.world import World
from slam.room_file import EDGE_KINDS, Properties, RoomFileError, read_features
from slam.simulation.world import read_plan

WALL, RECTANGLE, PLANNED_WALL = EDGE_KINDS[MapEdgeKind.REAL], "rectangle", "wall"
Feature = tuple[BaseGeometry, Properties]


@dataclass(frozen=True, eq=False)
class PlanningWorld:
    """A world, and the kind of the features that it was made from."""

    world: World
    taken: str


def read_world(path: Path, layer: str, sigmas: float = 0.0) -> PlanningWorld:
    """The world of any GeoJSON with kinds: a map's `layer`, else its free space, else obstacles in a boundary.

    Rectangles, and the walls of a floor plan with its obstacles and shut doors, enclose free space. sigmas: every wall
    edge keeps the robot away by as many of its own standard deviations.
    """
    features = read_features(path)
    of_kind: dict[str, list[BaseGeometry]] = {}
    for geometry, says in features:
        of_kind.setdefault(str(says.get("kind")), []).append(geometry)
    taken = next((kind for kind in (layer, "free", "boundary", RECTANGLE, PLANNED_WALL) if kind in of_kind), None)
    if taken is None:
        known = ", ".join(sorted(of_kind)) or "none at all"
        raise RoomFileError(f"{path}: no feature of kind safety, free, boundary, rectangle or wall, only {known}")
    if taken in (RECTANGLE, PLANNED_WALL):
        free = _enclosed(of_kind[taken] if taken == RECTANGLE else [body.outline for body in read_plan(path).solids])
    else:
        free = _polygons(shapely.union_all(shapely.make_valid(np.array(of_kind[taken]))))
    if free.is_empty:
        enclosing = taken in (RECTANGLE, PLANNED_WALL)
        raise RoomFileError(f"{path}: its {taken} {'encloses' if enclosing else 'leaves'} no area free")
    obstacles = [geometry for kind in ("obstacle", "wall", RECTANGLE) for geometry in of_kind.get(kind, [])]
    world = World.from_obstacles(free, obstacles) if taken == "boundary" else World.from_free_space(free)
    return PlanningWorld(world if sigmas == 0 else world.keep_away(*_clearances(path, features, sigmas)), taken)


def _clearances(path: Path, features: list[Feature], sigmas: float) -> tuple[Floats, Floats]:
    """The wall edges (k, 2, 2) of a map and what each keeps away (k,), metres."""
    walls = [(geometry, says["spread"]) for geometry, says in features if says.get("kind") == WALL and says["spread"]]
    if not walls:
        raise RoomFileError(f"{path}: no {WALL} with a spread, so no clearance can be a multiple of it")
    segments = np.array([shapely.get_coordinates(geometry) for geometry, _ in walls])
    return segments, sigmas * np.array([spread for _, spread in walls])


def _enclosed(solids: list[BaseGeometry]) -> MultiPolygon:
    """What lies inside the walls that solids make up once they are merged."""
    walls = shapely.union_all(solids)
    holes = [Polygon(ring) for part in _polygons(walls).geoms for ring in part.interiors]
    return _polygons(shapely.union_all(holes).difference(walls))


def _polygons(geometry: BaseGeometry) -> MultiPolygon:
    return MultiPolygon([part for part in shapely.get_parts(geometry) if isinstance(part, Polygon)])
