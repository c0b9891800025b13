"""Reading the map: from votes and fused faces back to polygons, with their provenance and what follows from it."""

from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage
from shapely import MultiPolygon

from backend.contours import as_polygons, assemble, contours
from backend.decisions import Decisions, decisions_of
from backend.doors import DoorSettings, Opening, doors_of
from backend.evidence import Counts
from backend.far_ground import far_ground
from backend.hidden_objects import ObjectSettings, apart_from, objects_in, without_slivers
from backend.leak_alarm import alarms, why
from backend.leak_repair import closed, open_bins, repaired, standing, supported_bins
from backend.provenance import boundary_edges, label_edges
from backend.room_map import Decision, MapEdge, Obstacle, RoomMap, Verdict
from backend.samples import Samples
from backend.seen_through import beams_of, met, seen_through
from backend.sight import Sight, sight_of
from backend.snapping import snap_ring
from backend.wall_faces import WallFaces

Floats = NDArray[np.float64]
SQUARE = np.sqrt(2)  # how far the corner of a square wall's inset lies off, over the inset: sharper ones are cut there


@dataclass(frozen=True)
class ReadingSettings:
    """Opinions about turning votes into a map, in metres."""

    opening: float = 0.05  # larger removes wider slits and spikes of free space
    roomy: float = 0.15  # larger clears only wider ground on a mere bound: a door's arc, a sonar's silence
    contested: float = 1 / 3  # of the views that looked there; larger raises the alarm for better measured surface only
    inset: float = 0.05  # larger keeps plans farther from surfaces
    spacing: float = 0.05  # larger labels faster, by fewer samples
    reach: float = 0.06  # larger lets samples farther off support an edge, and faces farther off attract it
    panel: float = 0.05  # larger makes repaired panels thicker
    deep: float = 0.10  # larger calls a piece of boundary overruled only farther inside the free space
    least_area: float = 0.25  # m²; larger forgets bigger patches of free space where no sensor stood
    objects: ObjectSettings = field(default_factory=ObjectSettings)
    doors: DoorSettings = field(default_factory=DoorSettings)


@dataclass(frozen=True, eq=False)
class PlacedViews:
    """Views as they voted, in rising order of index.

    index: (v,). rings: each (m, 2), counter-clockwise, of what is surely free; far: by row, the same ring up to its
    bounds, of views with a wide beam; aside: (n,) metres the surface of each sample may lie to its side;
    reals: each (m,), edge i to i + 1 was measured.
    readings: each (m, 2), where the thin beams ended, (0, 2) of a view with a wide beam.
    origins: (v, 2). openings: each (d, 2, 2) jambs the infrared reported.
    """

    index: NDArray[np.int64]
    rings: list[Floats]
    far: dict[int, Floats]
    aside: Floats
    reals: list[NDArray[np.bool_]]
    readings: list[Floats]
    origins: Floats
    openings: list[Floats]


def read_map(
    views: PlacedViews, samples: Samples, faces: WallFaces, counts: Counts, settings: ReadingSettings
) -> RoomMap:
    """The room map that the votes, the faces and the placed samples (rows of views) tell."""
    sight = sight_of(views.rings, views.origins)
    measured = supported_bins(samples, faces)
    beams = beams_of(sight, views.readings)
    through = seen_through(measured, beams, settings.panel)
    bins = measured.where(standing(measured, through))
    known = met(measured, beams)
    contested = known.where((known.support >= 2) & standing(known, through, settings.contested))
    mask = counts.free > counts.wall
    mask = closed(mask, bins.where(open_bins(bins, mask, counts)), counts, settings.panel)
    mask |= _far_ground(views, samples, mask, counts, settings.roomy)
    free = _polygons(mask, faces, counts, settings)
    free = _known_ground(free, views.origins, settings.least_area)
    free = repaired(without_slivers(free, samples.points, settings.reach, settings.objects), bins, settings.panel)
    edges = label_edges(boundary_edges(free), samples.thinned(settings.spacing), counts, settings.reach)
    objects = objects_in(free, edges, sight, settings.objects)
    walls = as_polygons(shapely.union_all([free, *(thing.outline for thing in objects if not thing.inferred)]))
    doors = doors_of(free, walls, _reported(views), sight, settings.doors)
    objects = apart_from(objects, doors, settings.doors.walls.beside)
    safety = as_polygons(free.buffer(-settings.inset, join_style="mitre", mitre_limit=SQUARE))
    deep = round(settings.deep / counts.cell)
    decided = Decisions(partial(_decisions, views, (mask, counts, deep), sight, (edges, objects)))
    leaks, told = alarms(free, contested, samples, beams, settings.panel)
    reasons = tuple(why(views.index[measuring], views.index[through]) for measuring, through in told)
    room_map = RoomMap(free, safety, edges, doors, objects, leaks, decided, reasons)
    return _by_index(room_map, views.index)


def _far_ground(
    views: PlacedViews, samples: Samples, mask: NDArray[np.bool_], counts: Counts, roomy: float
) -> NDArray[np.bool_]:
    """What the views only bound, as far as the others leave it free and a disc of radius `roomy` fits in."""
    cleared = mask.copy()
    for row, far in views.far.items():
        others = samples.view != row
        rings, surface = (views.rings[row], far), (samples.where(others), views.aside[others])
        cleared |= far_ground(views.origins[row], rings, views.openings[row], surface, counts)
    return _opened(cleared, round(roomy / counts.cell)) if views.far else cleared


def _opened(mask: NDArray[np.bool_], radius: int) -> NDArray[np.bool_]:
    """The mask without what a disc of `radius` cells does not fit into."""
    y, x = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    return np.asarray(ndimage.binary_opening(mask, x**2 + y**2 <= radius**2 + 0.5))


def _polygons(mask: NDArray[np.bool_], faces: WallFaces, counts: Counts, settings: ReadingSettings) -> MultiPolygon:
    """Free cells, opened, as polygons on the fused faces."""
    opened = _opened(mask, round(settings.opening / counts.cell))
    traced = [(ring + counts.corner) * counts.cell for ring in contours(opened)]
    rings = [snap_ring(ring, faces, settings.reach) for ring in traced]
    return as_polygons(shapely.simplify(assemble(rings), 0.75 * counts.cell))


def _known_ground(free: MultiPolygon, origins: Floats, least_area: float) -> MultiPolygon:
    """The parts where a sensor stood, and others only if they are large."""
    stood = shapely.MultiPoint(origins)
    return MultiPolygon([part for part in free.geoms if part.area >= least_area or part.intersects(stood)])


def _reported(views: PlacedViews) -> Opening:
    """The openings the views reported, each of weight one."""
    jambs = np.concatenate([np.empty((0, 2, 2)), *views.openings])
    view = np.repeat(np.arange(len(views.openings)), [len(opening) for opening in views.openings])
    return Opening(jambs, np.ones(len(jambs)), view)


def _decisions(
    views: PlacedViews,
    votes: tuple[NDArray[np.bool_], Counts, int],
    sight: Sight,
    found: tuple[tuple[MapEdge, ...], tuple[Obstacle, ...]],
) -> tuple[Decision, ...]:
    """What became of every piece of the views; votes: the free cells, and how many of them are deep inside."""
    (mask, counts, depth), (edges, objects) = votes, found
    inner = ndimage.minimum_filter(mask.view(np.uint8), 2 * depth + 1) > 0
    deep = []
    for ring in views.rings:
        cell = np.floor(0.5 * (ring + np.roll(ring, -1, axis=0)) / counts.cell).astype(np.int64) - counts.corner
        deep.append(inner[cell[:, 1], cell[:, 0]])
    made = decisions_of(views.rings, views.reals, deep, sight, edges)
    inferred = tuple(_inferred(thing, sight) for thing in objects if thing.inferred)
    index = views.index
    return tuple(replace(d, owners=index[d.owners], deciders=index[d.deciders]) for d in made + inferred)


def _inferred(thing: Obstacle, sight: Sight) -> Decision:
    """The decision to infer an object: by the views that see the ground around it."""
    outline = np.asarray(thing.outline.buffer(0.1).exterior.coords)
    _, seers = sight.pairs(outline)
    return Decision(
        Verdict.INFERRED, np.asarray(thing.outline.exterior.coords), np.empty(0, dtype=np.int64), np.unique(seers)
    )


def _by_index(room_map: RoomMap, index: NDArray[np.int64]) -> RoomMap:
    """The map with the rows of views replaced by their indices."""
    return replace(
        room_map,
        edges=tuple(replace(edge, views=index[edge.views]) for edge in room_map.edges),
        doors=tuple(replace(door, views=index[door.views]) for door in room_map.doors),
        obstacles=tuple(replace(thing, views=index[thing.views]) for thing in room_map.obstacles),
    )
