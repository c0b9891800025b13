"""Merging placed views into one room map (Flynn 1988, §4.1: match what can be matched, decide about the rest).

Views vote cell by cell, one-sidedly; the votes become polygons again, and every edge of these
says who measured it. A view can be added, moved and read at any time, in any order.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from backend.ballots import ballot_of
from backend.evidence import Ballot, EvidenceGrid
from backend.map_reading import PlacedViews, ReadingSettings, read_map
from backend.room_map import RoomMap
from backend.samples import Samples
from backend.settling import SettleSettings, settle
from backend.snapping import snap_view
from backend.surfaces import Surfaces, surfaces_of
from backend.view import View, place
from backend.wall_faces import FaceSettings, WallFaces, fuse_faces

Floats = NDArray[np.float64]


class MergingError(Exception):
    """A view that cannot be added or moved; the message names it."""


@dataclass(frozen=True)
class MergeSettings:
    """Opinions of the merge, in metres."""

    cell: float = 0.025  # larger is faster and coarser; at most half the thinnest wall
    piece: float = 0.10  # larger samples long edges more sparsely
    spacing: float = 0.05  # larger settles faster, on fewer samples
    finest: float = 0.01  # no spread is believed below this; larger blurs good sensors
    wall_strip: float = 0.06  # larger holds walls better and believes vaguer surfaces, and closes thinner slits
    settling: SettleSettings = field(default_factory=SettleSettings)
    faces: FaceSettings = field(default_factory=FaceSettings)
    reading: ReadingSettings = field(default_factory=ReadingSettings)


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
        surfaces = surfaces_of(view, self.settings.piece, self.settings.finest)
        ballot = self._ballot(surfaces, place(surfaces.ring, pose), place(view.origin[None], pose)[0])
        self._evidence.cast(ballot, 1)
        self._placed[index] = _Placed(view, surfaces, np.asarray(pose, dtype=np.float64), ballot)

    def move(self, index: int, pose: Floats) -> None:
        """Take the votes of a view back and cast them from another pose (3,)."""
        if index not in self._placed:
            raise MergingError(f"view {index} cannot move: it was never added")
        placed = self._placed.pop(index)
        self._evidence.cast(placed.ballot, -1)
        self.add(placed.view, pose, index)

    def result(self) -> RoomMap:
        """The room map of all views so far. Raises MergingError when there are none."""
        if not self._placed:
            raise MergingError("a map needs one view at least")
        local = self._samples()
        poses = settle(
            local.where(local.sure).thinned(self.settings.spacing),
            np.array([p.pose for _, p in self._in_order()]),
            self.settings.settling,
        )
        samples = local.placed(poses)
        faces = fuse_faces(samples, self.settings.faces)
        self._vote_again(poses, faces)
        return read_map(self._placed_views(poses), samples, faces, self._evidence.counts(), self.settings.reading)

    @property
    def evidence_bytes(self) -> int:
        """Memory the votes take."""
        return self._evidence.bytes

    def _placed_views(self, poses: Floats) -> PlacedViews:
        """The views as they voted."""
        everyone = self._in_order()
        origins = [place(placed.view.origin[None], pose)[0] for (_, placed), pose in zip(everyone, poses, strict=True)]
        openings = [
            place(p.view.openings.reshape(-1, 2), pose).reshape(-1, 2, 2)
            for (_, p), pose in zip(everyone, poses, strict=True)
        ]
        wide = [i for i, (_, placed) in enumerate(everyone) if placed.view.wide is not None]
        return PlacedViews(
            np.array([index for index, _ in everyone]),
            [placed.ballot.free * self.settings.cell for _, placed in everyone],
            {i: place(everyone[i][1].surfaces.far, poses[i]) for i in wide},
            np.concatenate([placed.surfaces.aside for _, placed in everyone]),
            [placed.surfaces.real for _, placed in everyone],
            np.array(origins),
            openings,
        )

    def _in_order(self) -> list[tuple[int, _Placed]]:
        return sorted(self._placed.items())

    def _ballot(self, surfaces: Surfaces, ring: Floats, origin: Floats) -> Ballot:
        """Votes on whole millimetres, so that a view that hardly moved need not vote again."""
        ring = np.round(ring, 3)
        sure = surfaces.spread <= self.settings.wall_strip  # else the wall may stand anywhere, also before the strip
        return ballot_of(
            ring, surfaces.real & sure & np.roll(sure, -1), origin, self.settings.wall_strip, self.settings.cell
        )

    def _vote_again(self, poses: Floats, faces: WallFaces) -> None:
        """Every view votes with its measured corners on the fused faces; only changed ballots are cast anew."""
        end = 0
        for (index, placed), pose in zip(self._in_order(), poses, strict=True):
            surfaces = placed.surfaces
            start, end = end, end + len(surfaces.corner)
            ring, origin = place(surfaces.ring, pose), place(placed.view.origin[None], pose)[0]
            snapped = snap_view(ring, origin, surfaces, faces.label[start:end], faces)
            ballot = self._ballot(surfaces, snapped, origin)
            if not np.array_equal(ballot.free, placed.ballot.free):
                self._evidence.cast(placed.ballot, -1)
                self._evidence.cast(ballot, 1)
                self._placed[index] = replace(placed, ballot=ballot)

    def _samples(self) -> Samples:
        """All measured corners in the frames of their views, view by view in the order of their indices."""
        surfaces = [placed.surfaces for _, placed in self._in_order()]
        return Samples(
            np.concatenate([s.ring[s.corner] for s in surfaces]),
            np.concatenate([s.normals for s in surfaces]),
            np.repeat(np.arange(len(surfaces)), [len(s.corner) for s in surfaces]),
            np.concatenate([s.sigma for s in surfaces]),
            np.concatenate([s.weight for s in surfaces]),
            np.concatenate([s.sure & (s.sigma <= self.settings.wall_strip) for s in surfaces]),
        )


def merge_views(views: Iterable[View], poses: Floats, settings: MergeSettings | None = None) -> RoomMap:
    """The room map of views at poses (n, 3)."""
    merger = Merger(settings)
    for index, (view, pose) in enumerate(zip(views, poses, strict=True)):
        merger.add(view, pose, index)
    return merger.result()
