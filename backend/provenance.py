"""Provenance: every edge of the merged boundary says which views measured it, and how many saw through it."""

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon

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
    if not len(edges):
        return ()
    edges = _cut(edges, samples, reach)
    inward = _inward(edges)
    edge, sample = _supports(edges, inward, samples, reach)
    views = _views_by_edge(edge, samples.view[sample], len(edges))
    offset = np.sum((samples.points[sample] - edges[edge, 0]) * inward[edge], axis=1)
    spread = _spread(edge, offset, len(edges))
    through = _seen_through(edges, inward, counts, reach)
    return tuple(
        MapEdge(
            (float(start[0]), float(start[1])),
            (float(end[0]), float(end[1])),
            MapEdgeKind.REAL if len(seen) else MapEdgeKind.FRONTIER,
            len(seen),
            int(contradictions),
            float(wide),
            seen,
        )
        for (start, end), seen, contradictions, wide in zip(edges, views, through, spread, strict=True)
    )


def _cut(edges: Floats, samples: Samples, reach: float) -> Floats:
    """The edges (f, 2, 2), stretches without a sample for four times the reach standing as edges of their own."""
    edge, sample = _supports(edges, _inward(edges), samples, reach)
    length = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    unit = (edges[:, 1] - edges[:, 0]) / np.maximum(length, 1e-9)[:, None]
    along = np.sum((samples.points[sample] - edges[edge, 0]) * unit[edge], axis=1)
    number = np.arange(len(edges))
    owner = np.concatenate([number, edge, number])
    mark = np.concatenate([np.zeros(len(edges)), np.clip(along, 0.0, length[edge]), length])
    order = np.lexsort((mark, owner))
    owner, mark = owner[order], mark[order]
    bare = np.flatnonzero((np.diff(mark) > 4 * reach) & (owner[1:] == owner[:-1]))
    margin = 1.01 * reach  # the samples at its ends shall not support a bare stretch
    first, last = mark[bare] + margin, mark[bare + 1] - margin
    inner = (mark[bare] > 0, mark[bare + 1] < length[owner[bare]])
    owner = np.concatenate([number, owner[bare][inner[0]], owner[bare][inner[1]], number])
    mark = np.concatenate([np.zeros(len(edges)), first[inner[0]], last[inner[1]], length])
    order = np.lexsort((mark, owner))
    owner, points = owner[order], edges[owner[order], 0] + mark[order, None] * unit[owner[order]]
    points[np.append(owner[1:] != owner[:-1], True)] = edges[:, 1]
    joined = owner[1:] == owner[:-1]
    return np.asarray(np.stack([points[:-1], points[1:]], axis=1)[joined])


def _inward(edges: Floats) -> Floats:
    """Unit normals (e, 2) towards the free side."""
    along = edges[:, 1] - edges[:, 0]
    length = np.maximum(np.linalg.norm(along, axis=1), 1e-9)
    return np.asarray(np.stack([-along[:, 1], along[:, 0]], axis=1) / length[:, None])


def _supports(edges: Floats, inward: Floats, samples: Samples, reach: float) -> tuple[Ints, Ints]:
    """Pairs (edge, sample) where the sample lies on the edge and faces its free side."""
    tree = shapely.STRtree([shapely.LineString(edge) for edge in edges])
    sample, edge = tree.query(shapely.points(samples.points), predicate="dwithin", distance=reach)
    same_side = np.sum(samples.normals[sample] * inward[edge], axis=1) > 0.5
    return edge[same_side], sample[same_side]


def _views_by_edge(edge: Ints, view: Ints, count: int) -> list[Ints]:
    """Distinct views of every edge."""
    pairs = np.unique(np.stack([edge, view], axis=1), axis=0)
    return np.split(pairs[:, 1], np.searchsorted(pairs[:, 0], np.arange(1, count)))


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
