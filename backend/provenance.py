"""Provenance: every edge of the merged boundary says which views measured it, and how many saw through it."""

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon

from backend.along_edges import Along, along_edges
from backend.evidence import Counts
from backend.room_map import MapEdge, MapEdgeKind
from backend.samples import Samples

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def boundary_edges(free: MultiPolygon) -> Floats:
    """All edges (e, 2, 2) of the free space, free on their left."""
    rings = [
        ring
        for part in free.geoms
        for ring in (shapely.orient_polygons(part).exterior, *shapely.orient_polygons(part).interiors)
    ]
    edges = [np.stack([np.asarray(ring.coords)[:-1], np.asarray(ring.coords)[1:]], axis=1) for ring in rings]
    return np.concatenate(edges) if edges else np.empty((0, 2, 2))


def label_edges(edges: Floats, samples: Samples, counts: Counts, reach: float) -> tuple[MapEdge, ...]:
    """Every edge (e, 2, 2) with its support by samples within `reach` metres that face the same side.

    An edge that was measured in part is cut where its measured part ends.
    """
    beside = along_edges(edges, samples, reach)
    edges, piece = _cut(edges, beside, reach)
    inward = _inward(edges)
    views = _views_by_edge(piece, samples.view[beside.sample], len(edges))
    spread = _spread(piece, beside.off, len(edges))
    through = _seen_through(edges, inward, counts, reach)
    return tuple(
        MapEdge(
            (start[0], start[1]),
            (end[0], end[1]),
            MapEdgeKind.REAL if len(seen) else MapEdgeKind.FRONTIER,
            len(seen),
            contradictions,
            wide,
            seen,
        )
        for (start, end), seen, contradictions, wide in zip(
            edges.tolist(), views, through.tolist(), spread.tolist(), strict=True
        )
    )


def _cut(edges: Floats, beside: Along, reach: float) -> tuple[Floats, Ints]:
    """The edges (f, 2, 2), stretches without a sample for four times the reach standing as edges of their own, and the
    edge (p,) among these that each sample supports."""
    length = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    unit = (edges[:, 1] - edges[:, 0]) / np.maximum(length, 1e-9)[:, None]
    number = np.arange(len(edges))
    owner = np.concatenate([number, beside.edge, number])
    mark = np.concatenate([np.zeros(len(edges)), beside.along, length])
    measured = np.repeat([False, True, False], [len(edges), len(beside.edge), len(edges)])
    order = np.lexsort((np.repeat([0, 1, 2], [len(edges), len(beside.edge), len(edges)]), mark, owner))
    owner, mark, measured = owner[order], mark[order], measured[order]
    bare = np.flatnonzero((np.diff(mark) > 4 * reach) & (owner[1:] == owner[:-1]))
    left, right = bare[measured[bare]], bare[measured[bare + 1]]
    cut_owner = np.concatenate([owner[left], owner[right]])
    cut_mark = np.concatenate([mark[left] + reach, mark[right + 1] - reach])
    order = np.lexsort((cut_mark, cut_owner))
    cut_owner, cut_mark = cut_owner[order], cut_mark[order]
    cuts = edges[cut_owner, 0] + cut_mark[:, None] * unit[cut_owner]
    before = np.searchsorted(cut_owner, number) + number  # the row of each edge's first piece
    starts = np.insert(cuts, np.searchsorted(cut_owner, number), edges[:, 0], axis=0)
    ends = np.insert(cuts, np.searchsorted(cut_owner, number, side="right"), edges[:, 1], axis=0)
    passed = np.searchsorted(cut_owner + cut_mark / (length[cut_owner] + 1), beside.edge + _share(beside, length))
    return np.stack([starts, ends], axis=1), before[beside.edge] + passed - np.searchsorted(cut_owner, beside.edge)


def _share(beside: Along, length: Floats) -> Floats:
    """How far along its edge each sample lies, in less than one."""
    return np.asarray(beside.along / (length[beside.edge] + 1))


def _inward(edges: Floats) -> Floats:
    """Unit normals (e, 2) towards the free side."""
    along = edges[:, 1] - edges[:, 0]
    length = np.maximum(np.linalg.norm(along, axis=1), 1e-9)
    return np.asarray(np.stack([-along[:, 1], along[:, 0]], axis=1) / length[:, None])


def _views_by_edge(edge: Ints, view: Ints, count: int) -> list[Ints]:
    """Distinct views of every edge."""
    many = int(view.max(initial=0)) + 1
    owner, seen = np.divmod(np.unique(edge * many + view), many)
    return np.split(seen, np.searchsorted(owner, np.arange(1, count)))[:count]


def _spread(edge: Ints, offset: Floats, count: int) -> Floats:
    """Standard deviation of the samples across their edge; infinite where there are none."""
    number = np.bincount(edge, minlength=count)
    known = np.maximum(number, 1)
    mean = np.bincount(edge, offset, count) / known
    variance = np.bincount(edge, offset**2, count) / known - mean**2
    return np.where(number > 0, np.sqrt(np.maximum(variance, 0.0)), np.inf)


def _seen_through(edges: Floats, inward: Floats, counts: Counts, depth: float) -> Ints:
    """How many views held the ground just behind each edge for free: the median over the edge."""
    share = np.array([0.1, 0.3, 0.5, 0.7, 0.9])[None, :, None]
    points = edges[:, None, 0] * (1 - share) + edges[:, None, 1] * share - depth * inward[:, None]
    free, _ = counts.at(points.reshape(-1, 2))
    return np.asarray(np.median(free.reshape(-1, 5), axis=1).astype(np.int64))
