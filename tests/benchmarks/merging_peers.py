"""Other ways to merge placed views, as references: union, shrink, k of n, symmetric vote."""

from collections.abc import Callable

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from backend.ballots import ballot_of
from backend.contours import as_polygons, assemble, contours
from backend.evidence import Ballot, Counts, EvidenceGrid
from backend.view import EdgeKind, View, place

Floats = NDArray[np.float64]
CELL = 0.025
BAND = 0.06


def plain_union(views: list[View], poses: Floats) -> MultiPolygon:
    """Everything any view holds for free."""
    shapes: list[BaseGeometry] = [Polygon(place(view.boundary, pose)) for view, pose in zip(views, poses, strict=True)]
    return _union(shapes)


def shrunk_union(views: list[View], poses: Floats) -> MultiPolygon:
    """The union after every view gave up 6 cm along its real edges."""
    shapes: list[BaseGeometry] = []
    for view, pose in zip(views, poses, strict=True):
        ring = place(view.boundary, pose)
        real = view.edges == EdgeKind.REAL
        walls = shapely.linestrings(np.stack([ring[real], np.roll(ring, -1, axis=0)[real]], axis=1))
        shapes.append(
            shapely.make_valid(Polygon(ring)).difference(shapely.union_all(shapely.buffer(walls, BAND, quad_segs=2)))
        )
    return _union(shapes)


def at_least(views: list[View], poses: Floats, agreeing: int) -> MultiPolygon:
    """Free where as many views agree."""
    counts = _counts([_rings(view, pose) for view, pose in zip(views, poses, strict=True)])
    return _polygons(counts.free >= agreeing, counts)


def symmetric_vote(views: list[View], poses: Floats) -> MultiPolygon:
    """Free where more views say free than wall, walls being bands on both sides of real edges."""
    ballots = []
    for view, pose in zip(views, poses, strict=True):
        ring, origin = place(view.boundary, pose), place(view.origin[None], pose)[0]
        beam = ring - origin
        length = np.linalg.norm(beam, axis=1, keepdims=True)
        nearer = origin + beam * np.maximum(1 - 0.5 * BAND / np.maximum(length, 1e-9), 0.0)
        band = ballot_of(nearer, view.edges == EdgeKind.REAL, origin, BAND, CELL)
        ballots.append(Ballot(ring / CELL, band.walls))
    counts = _counts(ballots)
    return _polygons(counts.free > counts.wall, counts)


PEERS: dict[str, Callable[[list[View], Floats], MultiPolygon]] = {
    "plain union": plain_union,
    "shrink 6 cm": shrunk_union,
    "2 of n": lambda views, poses: at_least(views, poses, 2),
    "3 of n": lambda views, poses: at_least(views, poses, 3),
    "symmetric vote": symmetric_vote,
}


def _union(shapes: list[BaseGeometry]) -> MultiPolygon:
    return as_polygons(shapely.union_all([shapely.make_valid(shape) for shape in shapes], grid_size=1e-4))


def _rings(view: View, pose: Floats) -> Ballot:
    return Ballot(place(view.boundary, pose) / CELL, np.empty((0, 2)))


def _counts(ballots: list[Ballot]) -> Counts:
    grid = EvidenceGrid(CELL)
    for ballot in ballots:
        grid.cast(ballot, 1)
    return grid.counts()


def _polygons(mask: NDArray[np.bool_], counts: Counts) -> MultiPolygon:
    free = assemble([(ring + counts.corner) * CELL for ring in contours(mask)])
    return as_polygons(shapely.simplify(free, 0.75 * CELL))
