"""A world to plan in: the free space as merged polygons, every edge with its outward normal and offset.

Touching, overlapping and chained polygons are merged first. All coordinates then lie on a grid of about 1e-8 of the
world's extent, and obstacles have grown by two steps of it: gaps that exist only through rounding are closed, and no
sliver or needle is lost. A planner that is right in this world is therefore right in the one it was given.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LinearRing, MultiPolygon, Polygon

Floats = NDArray[np.float64]
Geometries = NDArray[np.object_]

TANGENTS = 4  # sides of a hull around half a circle: 1 / cos(π / 8) of its radius where two of them meet
GROWTH = 2.0  # steps of the grid by which obstacles grow; a coordinate moves by at most 0.71 of a step when rounded
FINENESS = 1e-8  # grid over extent: far above the rounding of doubles, far below anything a robot feels


class WorldError(Exception):
    """Polygons that make no world; the message carries the numbers."""


@dataclass(frozen=True, eq=False)
class World:
    """Free space and its boundary.

    free: polygons with shells counter-clockwise and holes clockwise. edges: (m, 2, 2) start and end of every boundary
    edge, free space on the left. grid: the step that all coordinates are multiples of, metres.
    """

    free: MultiPolygon
    edges: Floats
    grid: float

    @classmethod
    def from_free_space(cls, free: Polygon | MultiPolygon) -> "World":
        """Everything outside `free` is obstacle."""
        grid = _grid_of(free)
        return _assemble(shapely.buffer(_sound(free), -GROWTH * grid, join_style="mitre"), grid)

    @classmethod
    def from_obstacles(cls, boundary: Polygon | MultiPolygon, obstacles: Sequence[shapely.Geometry]) -> "World":
        """The inside of `boundary` without `obstacles`, which may touch, overlap, cross themselves or have no area."""
        grid = _grid_of(boundary)
        inside = shapely.buffer(_sound(boundary), -GROWTH * grid, join_style="mitre")
        grown = shapely.buffer([_sound(each) for each in obstacles], GROWTH * grid, join_style="mitre")
        return _assemble(inside.difference(shapely.union_all(grown)), grid)

    def keep_away(self, segments: Floats, clearances: Floats) -> "World":
        """The world in which each of `segments` (k, 2, 2) keeps the robot away by its own clearance (k,), metres.

        Each segment grows to a hull that encloses all points nearer than its clearance, and around its ends at most 8 %
        more, so walls known badly keep a robot farther away than walls known well. Clearances of zero change nothing.
        """
        wanted = np.asarray(clearances, dtype=float) > 0
        distances = np.asarray(clearances, dtype=float)[wanted] + GROWTH * self.grid
        hulls = _stadia(np.asarray(segments, dtype=float)[wanted], distances)
        return _assemble(self.free.difference(shapely.union_all(hulls)), self.grid)

    @cached_property
    def normals(self) -> Floats:
        """(m, 2) unit normals of the edges, from the obstacle into free space."""
        along = self.edges[:, 1] - self.edges[:, 0]
        left = np.stack([-along[:, 1], along[:, 0]], axis=1)
        return np.asarray(left / np.linalg.norm(left, axis=1, keepdims=True))

    @cached_property
    def offsets(self) -> Floats:
        """(m,) distance of each edge's line from the origin along its normal: n · p."""
        return np.asarray(np.einsum("ij,ij->i", self.normals, self.edges[:, 0]))

    @cached_property
    def boundary(self) -> shapely.Geometry:
        """All rings of the free space."""
        return self.free.boundary

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x and y, greatest x and y."""
        left, bottom, right, top = self.free.bounds
        return left, bottom, right, top


def outside_arcs(distances: float | Floats, quarter: int) -> Floats:
    """Distances to buffer by, so that arcs in `quarter` chords per right angle stay outside the arcs of `distances`.

    The buffer of GEOS rounds the number of chords, so one chord spans at most one and a half of its even share.
    """
    return np.asarray(distances / np.cos(1.5 * np.pi / (4 * quarter)))


def _stadia(segments: Floats, distances: Floats) -> Geometries:
    """Hulls (k,) of all points within `distances` (k,) of `segments` (k, 2, 2): sides exact, ends in a few tangents.

    Few, for a map has a thousand walls, and every corner of a world costs its planners time.
    """
    along = segments[:, 1] - segments[:, 0]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    left = np.stack([-along[:, 1], along[:, 0]], axis=1)
    turns = np.pi * ((np.arange(TANGENTS) + 0.5) / TANGENTS - 0.5)
    reach = distances[:, None, None] / np.cos(np.pi / (2 * TANGENTS))
    arc = reach * (np.cos(turns)[:, None] * along[:, None] + np.sin(turns)[:, None] * left[:, None])
    return np.asarray(shapely.polygons(np.concatenate([segments[:, 1:] + arc, segments[:, :1] - arc], axis=1)))


def _grid_of(outline: Polygon | MultiPolygon) -> float:
    """A power of two near FINENESS of the extent, so that multiples are exact."""
    if outline.is_empty:
        raise WorldError("the world's outline is empty")
    left, bottom, right, top = outline.bounds
    return float(2.0 ** np.ceil(np.log2(max(right - left, top - bottom) * FINENESS)))


def _sound(polygon: shapely.Geometry) -> shapely.Geometry:
    """The same points as a valid geometry: crossings resolved, parts without area kept as lines."""
    return shapely.make_valid(polygon)


def _assemble(free: shapely.Geometry, grid: float) -> World:
    rounded = shapely.set_precision(free, grid)
    rings = [Polygon(*_straightened(part, grid)) for part in _polygons(rounded)]
    if not rings:
        raise WorldError("no free space is left between the obstacles")
    oriented = MultiPolygon([shapely.orient_polygons(part) for part in rings])
    edges = [np.stack([corners[:-1], corners[1:]], axis=1) for corners in _corners(oriented)]
    return World(oriented, np.concatenate(edges), grid)


def _polygons(geometry: shapely.Geometry) -> list[Polygon]:
    """The parts of a geometry that have area."""
    return [part for part in shapely.get_parts(geometry) if isinstance(part, Polygon) and not part.is_empty]


def _straightened(polygon: Polygon, grid: float) -> tuple[Floats, list[Floats]]:
    """Shell and holes without the corners that lie on the line of their neighbours, to half a step of the grid."""
    shell, *holes = [_without_collinear(ring, grid) for ring in (polygon.exterior, *polygon.interiors)]
    return shell, [hole for hole in holes if len(hole) > 3]


def _without_collinear(ring: LinearRing, grid: float) -> Floats:
    """Corners (k, 2) of a closed ring without those that lie within half a step of their neighbours' line."""
    closed = np.asarray(shapely.simplify(ring, grid / 2, preserve_topology=True).coords)
    opened = closed[:-1]
    before, after = opened[-1] - opened[0], opened[1] - opened[0]
    span = np.linalg.norm(opened[1] - opened[-1])
    bend = abs(before[0] * after[1] - before[1] * after[0]) / max(float(span), grid)
    if len(opened) > 3 and bend <= grid / 2:
        opened = opened[1:]
    return np.vstack([opened, opened[:1]])


def _corners(free: MultiPolygon) -> Iterable[Floats]:
    """The corners (k, 2) of every ring, closed."""
    for part in free.geoms:
        for ring in (part.exterior, *part.interiors):
            yield np.asarray(ring.coords)
