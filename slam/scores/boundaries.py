"""How well the map's surfaces lie on the true ones, and whether walls still stand between rooms."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely.geometry.base import BaseGeometry

Floats = NDArray[np.float64]
STEP = 0.02  # metres between samples along a boundary
THICKEST = 0.40  # metres; what is thicker is no two-sided wall
BESIDE = 0.10  # metres of free ground asked for on both sides of a breach


class MapScoreError(Exception):
    """A map that cannot be scored; the message says why."""


@dataclass(frozen=True)
class BoundaryScores:
    """Surfaces of the map against true ones: shares within 5 and 10 cm, distances in metres, angles in radians."""

    precision_5cm: float
    recall_5cm: float
    f1_5cm: float
    precision_10cm: float
    recall_10cm: float
    f1_10cm: float
    chamfer: float
    hausdorff_95: float
    angle_error: float
    corner_precision: float
    corner_recall: float


def boundary_scores(claimed: Floats, true: Floats, visible: BaseGeometry) -> BoundaryScores:
    """Scores of claimed surface edges (e, 2, 2) against true ones (t, 2, 2), of which those by `visible` ground count.

    Raises MapScoreError when no surface is claimed at all.
    """
    if not len(claimed):
        raise MapScoreError("the map claims no surface: none of its edges is real")
    there, here = samples(claimed), samples(true)
    shapely.prepare(visible)
    here = here[shapely.dwithin(visible, shapely.points(here), STEP)]
    off_truth, missed = distances(there, true), distances(here, claimed)
    near = [(float(np.mean(off_truth <= tol)), float(np.mean(missed <= tol))) for tol in (0.05, 0.10)]
    precision, recall = _corner_scores(corners(claimed), corners(true), visible)
    return BoundaryScores(
        *(*near[0], _f1(*near[0]), *near[1], _f1(*near[1])),
        chamfer=float(0.5 * (off_truth.mean() + missed.mean())),
        hausdorff_95=float(max(np.quantile(off_truth, 0.95), np.quantile(missed, 0.95))),
        angle_error=_angle_error(claimed, true),
        corner_precision=precision,
        corner_recall=recall,
    )


def edges_of(shape: BaseGeometry) -> Floats:
    """All boundary edges (e, 2, 2), free space on their left."""
    parts = [shapely.orient_polygons(part) for part in shapely.get_parts(shape)]
    rings = [np.asarray(ring.coords) for part in parts for ring in (part.exterior, *part.interiors)]
    return np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])


def samples(edges: Floats, step: float = STEP) -> Floats:
    """Points (n, 2) about every `step` metres along edges (e, 2, 2)."""
    number = np.maximum(np.round(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1) / step), 1).astype(np.int64)
    edge = np.repeat(np.arange(len(edges)), number)
    share = (np.arange(len(edge)) - np.repeat(np.cumsum(number) - number, number) + 0.5) / number[edge]
    return np.asarray(edges[edge, 0] + share[:, None] * (edges[edge, 1] - edges[edge, 0]))


def distances(points: Floats, edges: Floats) -> Floats:
    """Distance (n,) of every point to the nearest edge (e, 2, 2)."""
    tree = shapely.STRtree([shapely.LineString(edge) for edge in edges])
    pairs, away = tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    return np.asarray(away[np.argsort(pairs[0])])


def corners(edges: Floats, least_turn: float = np.radians(30)) -> Floats:
    """Points (c, 2) where one edge ends, the next starts, and the boundary turns by 30° or more."""
    after = {(round(x, 6), round(y, 6)): i for i, (x, y) in enumerate(edges[:, 0])}
    following = np.array([after.get((round(x, 6), round(y, 6)), -1) for x, y in edges[:, 1]])
    first, second = np.flatnonzero(following >= 0), following[following >= 0]
    one, two = edges[first, 1] - edges[first, 0], edges[second, 1] - edges[second, 0]
    turn = np.arctan2(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0], np.sum(one * two, axis=1))
    return np.asarray(edges[first, 1][np.abs(turn) >= least_turn])


def wall_breach(free: BaseGeometry, true_free: BaseGeometry) -> float:
    """Share of two-sided wall samples whose crossing, thickness and 10 cm on both sides, is wholly free in the map."""
    edges = edges_of(true_free)
    along = edges[:, 1] - edges[:, 0]
    number = np.maximum(np.round(np.linalg.norm(along, axis=1) / 0.10), 1).astype(np.int64)
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
    points, outward = samples(edges, 0.10), np.repeat(outward, number, axis=0)
    shapely.prepare(true_free)
    depths = np.arange(0.01, THICKEST + 0.005, 0.01)
    probes = points[:, None] + depths[None, :, None] * outward[:, None]
    free_again = shapely.contains_xy(true_free, probes[..., 0], probes[..., 1])
    two_sided = free_again.any(axis=1)
    thickness = depths[free_again.argmax(axis=1)][two_sided, None]
    start, out = points[two_sided], outward[two_sided]
    crossings = shapely.linestrings(np.stack([start - BESIDE * out, start + (thickness + BESIDE) * out], axis=1))
    shapely.prepare(free)
    return float(np.mean(shapely.covers(free, crossings))) if len(start) else 0.0


def _f1(precision: float, recall: float) -> float:
    return 2 * precision * recall / max(precision + recall, 1e-12)


def _angle_error(claimed: Floats, true: Floats, least: float = 0.3) -> float:
    """Mean angle, by length, between claimed edges of 30 cm or more and the nearest true edge; nan without any."""
    along = claimed[:, 1] - claimed[:, 0]
    length = np.linalg.norm(along, axis=1)
    long = length >= least
    if not long.any():
        return float("nan")
    tree = shapely.STRtree([shapely.LineString(edge) for edge in true])
    middles = claimed[long].mean(axis=1)
    nearest = np.atleast_1d(tree.nearest([shapely.Point(middle) for middle in middles]))
    other = true[nearest, 1] - true[nearest, 0]
    sine = along[long, 0] * other[:, 1] - along[long, 1] * other[:, 0]
    angle = np.arcsin(np.clip(np.abs(sine) / (length[long] * np.linalg.norm(other, axis=1)), 0, 1))
    return float(np.average(angle, weights=length[long]))


def _corner_scores(claimed: Floats, true: Floats, visible: BaseGeometry, within: float = 0.10) -> tuple[float, float]:
    """Precision against all true corners, recall of those by visible ground; nan where there are none."""
    seen = true[shapely.dwithin(visible, shapely.points(true), STEP)] if len(true) else true
    if not len(claimed) or not len(seen):
        return float("nan"), 0.0 if len(seen) else float("nan")
    right = np.isfinite(cKDTree(true).query(claimed, distance_upper_bound=within)[0])
    found = np.isfinite(cKDTree(claimed).query(seen, distance_upper_bound=within)[0])
    return float(right.mean()), float(found.mean())
