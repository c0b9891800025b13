"""Leaks: faces that views measured but the votes opened, closed again where nobody saw through from the front.

Behind a thin panel the views of the other side outvote its face, although none of them contradicts it.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon

from backend.cell_lines import distinct_views
from backend.contours import as_polygons
from backend.evidence import Counts
from backend.samples import Samples
from backend.wall_faces import WallFaces

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
BIN = 0.10  # metres of face that stand or fall together


@dataclass(frozen=True, eq=False)
class FaceBins:
    """Pieces of face, at most BIN long: middles and normals (b, 2), length (b,), support (b,) distinct views."""

    middles: Floats
    normals: Floats
    length: Floats
    support: Ints

    def where(self, chosen: NDArray[np.bool_]) -> "FaceBins":
        """The bins for which `chosen` (b,) holds."""
        return FaceBins(self.middles[chosen], self.normals[chosen], self.length[chosen], self.support[chosen])


def supported_bins(samples: Samples, faces: WallFaces) -> FaceBins:
    """The pieces of face that two views or more measured."""
    known = faces.label >= 0
    face, view = faces.label[known], samples.view[known]
    normal = faces.normals[face]
    arm = samples.points[known] - faces.centres[face]
    along = arm[:, 0] * normal[:, 1] - arm[:, 1] * normal[:, 0]
    piece = np.floor(along / BIN).astype(np.int64)
    _, kept, group = np.unique(piece * len(faces.centres) + face, return_index=True, return_inverse=True)
    low, high = np.full(len(kept), np.inf), np.full(len(kept), -np.inf)
    np.minimum.at(low, group, along)
    np.maximum.at(high, group, along)
    normals = normal[kept]
    middles = faces.centres[face[kept]] + 0.5 * (low + high)[:, None] * _along(normals)
    bins = FaceBins(middles, normals, high - low, distinct_views(group, view, len(kept)))
    return bins.where(bins.support >= 2)


def open_bins(bins: FaceBins, mask: NDArray[np.bool_], counts: Counts) -> NDArray[np.bool_]:
    """Bins (b,) whose ground behind is free, close by and as far as a wall is thick at least."""
    behind = [bins.middles - depth * bins.normals for depth in (1.2 * counts.cell, 2.4 * counts.cell)]
    cells = [np.floor(points / counts.cell).astype(np.int64) - counts.corner for points in behind]
    return np.asarray(np.all([mask[cell[:, 1], cell[:, 0]] for cell in cells], axis=0))


def standing(bins: FaceBins, through: Ints, share: float = 0.5) -> NDArray[np.bool_]:
    """Bins (b,) that more than a share of those views measured that looked at them from the front.

    The others saw through (b,).
    """
    return np.asarray((1 - share) * bins.support > share * through)


def closed(mask: NDArray[np.bool_], bins: FaceBins, counts: Counts, depth: float) -> NDArray[np.bool_]:
    """The mask of free cells without the strips, `depth` metres thick, behind the bins."""
    across = np.arange(0.25 * counts.cell, depth, 0.5 * counts.cell)
    beside = np.linspace(-0.5, 0.5, 1 + int(np.ceil(2 * BIN / counts.cell))) * bins.length[:, None]
    strip = bins.middles[:, None] + beside[:, :, None] * _along(bins.normals)[:, None]
    strip = strip[:, :, None] - across[:, None] * bins.normals[:, None, None]
    column, row = (np.floor(strip.reshape(-1, 2) / counts.cell).astype(np.int64) - counts.corner).T
    repaired = mask.copy()
    repaired[row, column] = False
    return repaired


def _along(normals: Floats) -> Floats:
    return np.stack([normals[:, 1], -normals[:, 0]], axis=1)


def leaking(free: MultiPolygon, bins: FaceBins, tolerance: float) -> FaceBins:
    """The bins that lie more than `tolerance` metres inside the free space."""
    shapely.prepare(free)
    inside = bins.where(shapely.contains_xy(free, bins.middles))
    tree = shapely.STRtree(shapely.get_parts(free.boundary))
    near, _ = tree.query(shapely.points(inside.middles), predicate="dwithin", distance=tolerance)
    deep = np.ones(len(inside.support), dtype=np.bool_)
    deep[near] = False
    return inside.where(deep)


def repaired(free: MultiPolygon, bins: FaceBins, depth: float) -> MultiPolygon:
    """The free space without a strip of a whole bin, `depth` metres thick, behind each bin that lies as deep in it."""
    found = leaking(free, bins, depth)
    half = 0.5 * BIN * _along(found.normals)
    start, end, back = found.middles - half, found.middles + half, depth * found.normals
    corners = np.stack([start, end, end - back, start - back], axis=1)
    return as_polygons(free.difference(shapely.union_all(shapely.polygons(corners)))) if len(corners) else free
