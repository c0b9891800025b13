"""Merging placed views into one room map (Flynn 1988, §4.1: match what can be matched, decide about the rest).

Views vote cell by cell, one-sidedly; the votes become polygons again, and every edge of these
says who measured it. A view can be added, moved and read at any time, in any order.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from backend.ballots import ballot_of
from backend.evidence import Ballot, EvidenceGrid
from backend.grazing import GrazingSettings, up_to_mirrors, walls_of
from backend.half_steps import by_half_steps
from backend.map_reading import PlacedViews, ReadingSettings, read_map
from backend.room_map import RoomMap
from backend.samples import Samples
from backend.settled_poses import SettledPoses
from backend.settling import SettleSettings
from backend.snapping import onto_faces, snap_view
from backend.surfaces import Surfaces, surfaces_of
from backend.view import View, place
from backend.wall_faces import FaceSettings, WallFaces, fuse_faces

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
VOTED = 1e-3  # metres a corner may lie off its vote
STILL = np.array([1e-3, 1e-3, 1e-4])  # metres and radians of a pose that change nothing


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
    grazing: GrazingSettings = field(default_factory=GrazingSettings)
    reading: ReadingSettings = field(default_factory=ReadingSettings)


@dataclass(frozen=True, eq=False)
class _Placed:
    view: View
    surfaces: Surfaces
    pose: Floats
    ballot: Ballot
    voted: Floats  # the pose (3,) it voted from: where it settled, once the map was read


class Merger:
    """A map that grows: views are added and moved, the result is read when it is wanted."""

    def __init__(self, settings: MergeSettings | None = None) -> None:
        self.settings = settings or MergeSettings()
        self._evidence = EvidenceGrid(self.settings.cell)
        self._placed: dict[int, _Placed] = {}
        self._settled = SettledPoses(self.settings.settling)

    def add(self, view: View, pose: Floats, index: int) -> None:
        """Let the view `index` vote from its pose (3,). Raises MergingError if it already did."""
        if index in self._placed:
            raise MergingError(f"view {index} is in the map already: move it instead")
        surfaces = surfaces_of(by_half_steps(view), self.settings.piece, self.settings.finest)
        ballot = self._ballot(surfaces, place(surfaces.ring, pose), place(view.origin[None], pose)[0])
        self._evidence.cast(ballot, 1)
        given = np.asarray(pose, dtype=np.float64)
        self._placed[index] = _Placed(view, surfaces, given, ballot, given)

    def move(self, index: int, pose: Floats) -> None:
        """Take the votes of a view back and cast them from another pose (3,)."""
        if index not in self._placed:
            raise MergingError(f"view {index} cannot move: it was never added")
        view = self._placed[index].view
        self.remove(index)
        self.add(view, pose, index)

    def remove(self, index: int) -> None:
        """Take a view out of the map. Raises MergingError if it is not in it."""
        if index not in self._placed:
            raise MergingError(f"view {index} cannot be removed: it was never added")
        self._evidence.cast(self._placed.pop(index).ballot, -1)
        self._settled.forget(index)

    def follow(self, views: Sequence[View], poses: Floats) -> None:
        """Hold these views at poses (n, 3), numbered as they come, and no others: only what changed votes anew.

        A view that moved by less than a millimetre and turned by less than a tenth of a milliradian stays where it is.
        Raises MergingError, before anything changed, where poses are missing or too many.
        """
        if len(views) != len(poses):
            raise MergingError(f"{len(views)} views cannot stand at {len(poses)} poses")
        for index in [index for index in self._placed if index >= len(views)]:
            self.remove(index)
        for index, (view, pose) in enumerate(zip(views, poses, strict=True)):
            known = self._placed.get(index)
            if known is not None and not known.view.says_the_same(view):
                self.remove(index)
                known = None
            if known is None:
                self.add(view, pose, index)
            elif np.any(np.abs(pose - known.pose) > STILL):
                self.move(index, pose)

    def result(self) -> RoomMap:
        """The room map of all views so far. Raises MergingError when there are none."""
        if not self._placed:
            raise MergingError("a map needs one view at least")
        local = self._samples()
        given = np.array([placed.pose for _, placed in self._in_order()])
        sure = local.where(local.sure).thinned(self.settings.spacing)
        poses = self._settled.settled(sure, np.array(sorted(self._placed)), given)
        samples = local.placed(poses)
        faces = fuse_faces(samples, self.settings.faces)
        far = self._vote_again(poses, (samples, faces))
        return read_map(self._placed_views(poses, far), samples, faces, self._evidence.counts(), self.settings.reading)

    @property
    def evidence_bytes(self) -> int:
        """Memory the votes take."""
        return self._evidence.bytes

    def _placed_views(self, poses: Floats, far: dict[int, Floats]) -> PlacedViews:
        """The views as they voted; far: by row, the far rings of the wide ones."""
        everyone = self._in_order()
        openings = [
            place(p.view.openings.reshape(-1, 2), pose).reshape(-1, 2, 2)
            for (_, p), pose in zip(everyone, poses, strict=True)
        ]
        return PlacedViews(
            np.array([index for index, _ in everyone]),
            [placed.ballot.free * self.settings.cell for _, placed in everyone],
            far,
            np.concatenate([placed.surfaces.aside for _, placed in everyone]),
            [placed.surfaces.real for _, placed in everyone],
            [_readings(placed.view, pose) for (_, placed), pose in zip(everyone, poses, strict=True)],
            self._origins(poses),
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

    def _origins(self, poses: Floats) -> Floats:
        """Where the sensors of the views sat (v, 2)."""
        everyone = zip(self._in_order(), poses, strict=True)
        return np.array([place(placed.view.origin[None], pose)[0] for (_, placed), pose in everyone])

    def _vote_again(self, poses: Floats, measured: tuple[Samples, WallFaces]) -> dict[int, Floats]:
        """Every view votes with its measured corners on the fused faces; only changed ballots are cast anew.

        Views of a wide beam vote no farther than mirrors let them see; their far rings (m, 2) up to there, by row.
        """
        everyone, origins, far = self._in_order(), self._origins(poses), {}
        samples, faces = measured
        wide = any(placed.view.wide is not None for _, placed in everyone)
        rings = [place(placed.surfaces.ring, pose) for (_, placed), pose in zip(everyone, poses, strict=True)]
        walls = walls_of(faces, samples, rings, origins, self.settings.grazing) if wide else None
        ends = np.searchsorted(samples.view, np.arange(len(everyone) + 1))
        again = np.arange(len(everyone)) if wide else self._moved(poses, samples, origins, faces)
        for row in again:
            index, placed = everyone[row]
            surfaces = placed.surfaces
            start, end = ends[row], ends[row + 1]
            snapped = snap_view(rings[row], origins[row], surfaces, faces.label[start:end], faces)
            if walls is not None and placed.view.wide is not None:
                snapped, far[row] = up_to_mirrors(snapped, place(surfaces.far, poses[row]), origins[row], walls)
            ballot = self._ballot(surfaces, snapped, origins[row])
            if np.array_equal(ballot.free, placed.ballot.free):
                ballot = placed.ballot  # what was cast is what can be taken back
            else:
                self._evidence.cast(placed.ballot, -1)
                self._evidence.cast(ballot, 1)
            self._placed[index] = replace(placed, ballot=ballot, voted=poses[row])
        return far

    def _moved(self, poses: Floats, samples: Samples, origins: Floats, faces: WallFaces) -> Ints:
        """The views, by row, that settled elsewhere than they voted, or whose corners lie a millimetre off by now."""
        everyone = self._in_order()
        voted = np.concatenate([placed.ballot.free[placed.surfaces.corner] for _, placed in everyone])
        corners = onto_faces(samples.points, origins[samples.view], faces.label, faces)
        off = np.abs(corners - self.settings.cell * voted).max(axis=1) > VOTED
        moved = np.any(np.array([placed.voted for _, placed in everyone]) != poses, axis=1)
        moved[samples.view[off]] = True
        return np.flatnonzero(moved)

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


def _readings(view: View, pose: Floats) -> Floats:
    """Where the thin beams of a view ended, placed (m, 2); none of a wide beam."""
    return place(view.boundary if view.wide is None else view.boundary[:0], pose)


def merge_views(views: Iterable[View], poses: Floats, settings: MergeSettings | None = None) -> RoomMap:
    """The room map of views at poses (n, 3)."""
    merger = Merger(settings)
    merger.follow(list(views), poses)
    return merger.result()
