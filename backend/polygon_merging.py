"""Merging placed views into one room map (Flynn 1988, §4.1: match what can be matched, decide about the rest).

Views vote cell by cell, one-sidedly; the votes become polygons again, and every edge of these
says who measured it. A view can be added, moved and read at any time, in any order.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage
from shapely import MultiPolygon

from backend.ballots import ballot_of
from backend.contours import as_polygons, assemble, contours
from backend.evidence import Ballot, Counts, EvidenceGrid
from backend.provenance import Samples, boundary_edges, label_edges
from backend.room_map import RoomMap
from backend.surfaces import Surfaces, surfaces_of
from backend.view import View, place

Floats = NDArray[np.float64]


class MergingError(Exception):
    """A view that cannot be added or moved; the message names it."""


@dataclass(frozen=True)
class MergeSettings:
    """Opinions of the merge, in metres."""

    cell: float = 0.025  # larger is faster and coarser; at most half the thinnest wall
    piece: float = 0.10  # larger samples long edges more sparsely
    finest: float = 0.01  # no spread is believed below this; larger blurs good sensors
    wall_strip: float = 0.06  # larger holds walls better against misplaced views, and closes thinner slits
    opening: float = 0.05  # larger removes wider slits and spikes of free space
    inset: float = 0.05  # larger keeps plans farther from surfaces
    reach: float = 0.06  # larger lets samples farther off support an edge


@dataclass(frozen=True, eq=False)
class _Placed:
    view: View
    surfaces: Surfaces
    pose: Floats
    ballot: Ballot


class Merger:
    """A map that grows: views are added and moved, the result is read when it is wanted."""

    def __init__(self, settings: MergeSettings | None = None) -> None:
        self.settings = settings or MergeSettings()
        self._evidence = EvidenceGrid(self.settings.cell)
        self._placed: dict[int, _Placed] = {}

    def add(self, view: View, pose: Floats, index: int) -> None:
        """Let the view `index` vote from its pose (3,). Raises MergingError if it already did."""
        if index in self._placed:
            raise MergingError(f"view {index} is in the map already: move it instead")
        self._place(index, view, surfaces_of(view, self.settings.piece, self.settings.finest), pose)

    def move(self, index: int, pose: Floats) -> None:
        """Take the votes of a view back and cast them from another pose (3,)."""
        if index not in self._placed:
            raise MergingError(f"view {index} cannot move: it was never added")
        placed = self._placed[index]
        self._evidence.cast(placed.ballot, -1)
        self._place(index, placed.view, placed.surfaces, pose)

    def result(self) -> RoomMap:
        """The room map of all views so far."""
        counts = self._evidence.counts()
        free = _free_space(counts, self.settings)
        edges = boundary_edges(free)
        labelled = label_edges(edges, self._samples(), counts, self.settings.reach)
        safety = as_polygons(free.buffer(-self.settings.inset, join_style="mitre"))
        return RoomMap(free, safety, labelled, (), (), np.empty((0, 2)))

    def _place(self, index: int, view: View, surfaces: Surfaces, pose: Floats) -> None:
        ring, origin = place(surfaces.ring, pose), place(view.origin[None], pose)[0]
        ballot = ballot_of(ring, surfaces.real, origin, self.settings.wall_strip, self.settings.cell)
        self._evidence.cast(ballot, 1)
        self._placed[index] = _Placed(view, surfaces, np.asarray(pose, dtype=np.float64), ballot)

    def _samples(self) -> Samples:
        """All measured corners, placed, view by view in the order of their indices."""
        everyone = sorted(self._placed.items())
        turn = np.array([0.0, 0.0, 1.0])
        return Samples(
            np.concatenate([place(p.surfaces.ring[p.surfaces.corner], p.pose) for _, p in everyone]),
            np.concatenate([place(p.surfaces.normals, p.pose * turn) for _, p in everyone]),
            np.concatenate([np.full(len(p.surfaces.corner), index) for index, p in everyone]),
            np.concatenate([p.surfaces.sigma for _, p in everyone]),
            np.concatenate([p.surfaces.weight for _, p in everyone]),
        )


def merge_views(views: Iterable[View], poses: Floats, settings: MergeSettings | None = None) -> RoomMap:
    """The room map of views at poses (n, 3)."""
    merger = Merger(settings)
    for index, (view, pose) in enumerate(zip(views, poses, strict=True)):
        merger.add(view, pose, index)
    return merger.result()


def _free_space(counts: Counts, settings: MergeSettings) -> MultiPolygon:
    """Cells more views hold for free than for wall, opened, as polygons."""
    radius = round(settings.opening / settings.cell)
    y, x = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    mask = ndimage.binary_opening(counts.free > counts.wall, x**2 + y**2 <= radius**2 + 0.5)
    rings = [(ring + counts.corner) * counts.cell for ring in contours(mask)]
    free = assemble(rings)
    return as_polygons(shapely.simplify(free, 0.75 * settings.cell))
