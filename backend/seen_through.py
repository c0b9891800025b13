"""Seen through: the views whose beams passed pieces of face, which says more than that their free space reaches behind.

Far out the beams of a scan stand farther apart than pillars and door jambs are wide, and along a corridor two of them
bracket metres of wall: the free space drawn between two readings is a guess, and no view contradicts what stands there.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from backend.leak_repair import BIN, FaceBins
from backend.sight import Sight

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
TURN = 8.0  # more than a full turn in radians: what the bearings of one view lie apart from the next view's


@dataclass(frozen=True, eq=False)
class Beams:
    """Sight, and the thin beams of its views, view by view in rising order of bearing.

    sight: what all views hold for free. first: (v + 1,) where each view's beams begin; bearing, reach: (b,) of each,
    radians within ±π and metres. A view without beams is one of wide beams, which leave no gaps between them.
    """

    sight: Sight
    first: Ints
    bearing: Floats
    reach: Floats

    def beside(self, points: Floats, view: Ints) -> Ints:
        """The two beams (n, 2) of view (n,) that points (n, 2) lie between; views with beams only."""
        arm = points - self.sight.origins[view]
        owner = np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))
        next_one = np.searchsorted(TURN * owner + self.bearing, TURN * view + np.arctan2(arm[:, 1], arm[:, 0]))
        start, end = self.first[view], self.first[view + 1]
        return np.stack([np.where(next_one > start, next_one, end) - 1, np.where(next_one < end, next_one, start)], 1)


def beams_of(sight: Sight, rings: list[Floats]) -> Beams:
    """The beams of views from the placed readings (m, 2) of each; none (0, 2) of those with wide beams."""
    view = np.repeat(np.arange(len(rings)), [len(ring) for ring in rings])
    arm = np.concatenate(rings) - sight.origins[view]
    reach, bearing = np.linalg.norm(arm, axis=1), np.arctan2(arm[:, 1], arm[:, 0])
    order = np.lexsort((bearing, view))
    order = order[reach[order] > 1e-6]
    return Beams(sight, np.searchsorted(view[order], np.arange(len(rings) + 1)), bearing[order], reach[order])


def seers(pieces: FaceBins, among: FaceBins, beams: Beams, depth: float) -> tuple[Ints, Ints]:
    """All (piece, view) where the view saw from the front to `depth` metres behind the piece.

    One of its beams passed there, or both beams beside it passed through measured surface, which is `among` the bins.
    """
    piece, view = beams.sight.pairs(pieces.middles - depth * pieces.normals)
    ahead = np.sum((beams.sight.origins[view] - pieces.middles[piece]) * pieces.normals[piece], axis=1) > 0
    piece, view = piece[ahead], view[ahead]
    through = beams.first[view] == beams.first[view + 1]
    thin = np.flatnonzero(~through)
    through[thin] = _passed(pieces.where(piece[thin]), view[thin], (among, beams), depth)
    return piece[through], view[through]


def seen_through(bins: FaceBins, beams: Beams, depth: float) -> Ints:
    """How many views (b,) saw from the front to `depth` metres behind each bin."""
    return np.bincount(seers(bins, bins, beams, depth)[0], minlength=len(bins.support))


def met(bins: FaceBins, beams: Beams) -> FaceBins:
    """The bins, supported only by views whose beams ended there: what is drawn between two readings nobody measured.

    Wide beams leave no gaps between them: with any, the bins stay as they are.
    """
    number = np.diff(beams.first)
    if not number.all():
        return bins
    view = np.repeat(np.arange(len(number)), number)
    way = np.stack([np.cos(beams.bearing), np.sin(beams.bearing)], axis=1)
    readings = cKDTree(beams.sight.origins[view] + beams.reach[:, None] * way)
    near = readings.query_ball_point(bins.middles, BIN)
    support = np.array([len(np.unique(view[which])) for which in near], dtype=np.int64)
    return replace(bins, support=np.minimum(support, bins.support))


def _passed(pieces: FaceBins, view: Ints, seen: tuple[FaceBins, Beams], depth: float) -> NDArray[np.bool_]:
    """Whether beams of view (n,) passed through pieces (n,), or through measured surface on both sides of them."""
    among, beams = seen
    beside = beams.beside(pieces.middles - depth * pieces.normals, view)
    origin, normals = beams.sight.origins[view], pieces.normals
    way = np.stack([np.cos(beams.bearing[beside]), np.sin(beams.bearing[beside])], axis=2)
    height = np.sum((origin - pieces.middles) * normals, axis=1)[:, None]
    descent = -np.sum(way * normals[:, None], axis=2)
    past = beams.reach[beside] * descent > height + depth
    share = np.divide(height, descent, out=np.zeros_like(descent), where=past)
    crossing = origin[:, None] + share[:, :, None] * way
    here = past & (np.linalg.norm(crossing - pieces.middles[:, None], axis=2) < BIN)
    off, nearest = cKDTree(among.middles).query(crossing)
    alike = np.sum(among.normals[nearest] * normals[:, None], axis=2) > 0.8
    return np.asarray(here.any(axis=1) | np.all(past & (off < BIN) & alike, axis=1))
