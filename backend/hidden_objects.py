"""Hidden objects: what the views enclose without anyone seeing it whole (Flynn 1988, §4.1, Figs 11–12).

A hole of the free space is an object. It is measured if its boundary is mostly surface somebody saw, and inferred if
it is mostly line of sight; a notch nobody saw is inferred unless it is a mere shadow of something else.
"""

from dataclasses import dataclass, field

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely import MultiPolygon, Polygon

from backend.contours import as_polygons
from backend.occluders import OccluderSettings, Rim, occluders, rims_of
from backend.room_map import Door, MapEdge, MapEdgeKind, Obstacle
from backend.sight import Sight

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ObjectSettings:
    """Opinions about objects."""

    sliver: float = 0.005  # m²; larger forgets bigger unconfirmed holes
    largest: float = 6.0  # m²; larger calls bigger blocks of building an object
    wall: float = 0.25  # metres of mean thickness; larger takes thicker long things for walls
    longest: float = 1.5  # metres; larger lets longer thin things pass as objects
    real_share: float = 0.3  # larger asks for more seen surface before an object counts as measured
    pocket: float = 0.30  # metres; larger infers objects from wider notches in the boundary
    least_pocket: float = 0.04  # m²; larger infers only bigger objects
    looked_at: float = 0.5  # share of a notch's rim; larger takes more notches for shadows of what stands before them
    least: float = 0.01  # m²; larger names only bigger objects: a lone repaired piece of face is none
    occluders: OccluderSettings = field(default_factory=OccluderSettings)


def without_slivers(free: MultiPolygon, surface: Floats, reach: float, settings: ObjectSettings) -> MultiPolygon:
    """The free space with its small holes filled that no measured point (n, 2) lies within `reach` metres of."""
    slivers = [Polygon(ring) for part in free.geoms for ring in part.interiors]
    slivers = [hole for hole in slivers if hole.area <= settings.sliver]
    measured = cKDTree(surface)
    empty = [hole for hole in slivers if not _measured(hole, measured, reach)]
    return as_polygons(shapely.union_all([free, *empty]))


def _measured(hole: Polygon, surface: cKDTree, reach: float) -> bool:
    outline = shapely.segmentize(hole.exterior, reach)
    distance, _ = surface.query(np.asarray(outline.coords), distance_upper_bound=reach)
    return bool(np.isfinite(distance).any())


def objects_in(
    free: MultiPolygon, edges: tuple[MapEdge, ...], sight: Sight, settings: ObjectSettings
) -> tuple[Obstacle, ...]:
    """Measured and inferred objects: holes of the free space, and of its outer boundary the pockets that nobody saw
    and the bodies that cast the shadows, closed."""
    holes = [Polygon(ring) for part in free.geoms for ring in part.interiors]
    things = [hole for hole in holes if settings.least <= hole.area <= settings.largest]
    tree = shapely.STRtree([shapely.LineString([edge.start, edge.end]) for edge in edges])
    found = [_judged(thing, tree, edges, settings) for thing in things if not _is_wall(thing, settings)]
    judged = [thing for thing in found if not thing.inferred or thing.outline.area >= settings.least_pocket]
    rims = rims_of(free, edges, sight, settings.occluders)
    pockets = [_judged(pocket, tree, edges, settings) for pocket in _pockets(free, settings)]
    hidden = [p for p in pockets if p.inferred and _looked_at(p.outline, rims) >= settings.looked_at]
    bodies = occluders(free, rims, settings.occluders)
    closed = [_closed(body, tree, edges) for body in bodies if body.area >= settings.least_pocket]
    known = shapely.union_all([thing.outline for thing in (*judged, *closed)])
    return tuple(judged + closed + [pocket for pocket in hidden if not pocket.outline.intersects(known)])


def _looked_at(pocket: Polygon, rims: list[Rim]) -> float:
    """Which share of a pocket's rim some view saw face on: what is seen along lines of sight only is a shadow."""
    outline = shapely.buffer(pocket.exterior, 1e-2)
    shapely.prepare(outline)
    flags = np.concatenate([rim.looked_at[shapely.contains_xy(outline, rim.middles)] for rim in rims])
    return float(flags.mean()) if len(flags) else 0.0


def _closed(body: Polygon, tree: shapely.STRtree, edges: tuple[MapEdge, ...]) -> Obstacle:
    """A body seen in part as an inferred object, with the views that measured its front."""
    near = tree.query(body.buffer(1e-3), predicate="intersects")
    views = np.unique(np.concatenate([np.empty(0, dtype=np.int64), *(edges[int(i)].views for i in near)]))
    return Obstacle(body, True, len(views), views)


def apart_from(objects: tuple[Obstacle, ...], doors: tuple[Door, ...], reach: float) -> tuple[Obstacle, ...]:
    """The objects without those inferred ones that a door's jamb lies within `reach` metres of: ends of walls."""
    jambs = shapely.MultiPoint(np.concatenate([np.empty((0, 2)), *(door.jambs for door in doors)]))
    return tuple(thing for thing in objects if not (thing.inferred and thing.outline.dwithin(jambs, reach)))


def _is_wall(hole: Polygon, settings: ObjectSettings) -> bool:
    """Whether the hole is a stretch of wall between rooms: long, and thin for its length."""
    length = 0.5 * hole.exterior.length
    return length > settings.longest and hole.area / length < settings.wall


def _judged(thing: Polygon, tree: shapely.STRtree, edges: tuple[MapEdge, ...], settings: ObjectSettings) -> Obstacle:
    """The object with what speaks for it: seen surface, or else the views' lines of sight around it."""
    rim = thing.exterior.buffer(1e-3)
    near = [(edges[int(i)], tree.geometries[int(i)].intersection(rim).length) for i in tree.query(rim)]
    along = [(edge, length) for edge, length in near if length > 0.01]
    seen = sum(length for edge, length in along if edge.kind == MapEdgeKind.REAL)
    views = np.unique(np.concatenate([np.empty(0, dtype=np.int64), *(edge.views for edge, _ in along)]))
    return Obstacle(thing, seen < settings.real_share * thing.exterior.length, len(views), views)


def _pockets(free: MultiPolygon, settings: ObjectSettings) -> list[Polygon]:
    """Notches of the outer boundary, narrower than twice the pocket width, and a third of it thick somewhere."""
    radius = settings.pocket
    solid = shapely.union_all([Polygon(part.exterior) for part in free.geoms])
    notches = solid.buffer(radius, join_style="mitre").buffer(-radius, join_style="mitre").difference(solid)
    notches = notches.buffer(-radius / 6, join_style="mitre").buffer(radius / 6, join_style="mitre")
    return [
        notch
        for notch in shapely.get_parts(notches)
        if isinstance(notch, Polygon) and notch.area > settings.least_pocket
    ]
