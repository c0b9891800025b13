"""The modified curvature primal sketch: a contour reduced to knots joined by straight lines (Flynn 1988, §4).

Three layers stay apart. Landmark knots are significant, lie on measured surface and may be matched; geometry knots
bound the radial error of the polyline and are never matched; fitted lines are the walls between them.
"""

from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from frontend.contour import Contour, EdgeKind
from frontend.jambs import JambSettings, find_jambs
from frontend.landmarks import LandmarkSettings, chain_knots
from frontend.lines import Lines, wall_lines
from frontend.polyline import bounded_vertices
from frontend.primitives import Primitive
from frontend.scan import Booleans, Floats, Integers


class KnotKind(IntEnum):
    """The primitive a knot belongs to; JAMB is where a near surface ends, GEOMETRY only bounds the polyline."""

    CORNER = Primitive.CORNER
    SMOOTH_JOIN = Primitive.SMOOTH_JOIN
    END = Primitive.END
    CRANK = Primitive.CRANK
    BUMP = Primitive.BUMP
    DENT = Primitive.DENT
    JAMB = 6
    GEOMETRY = 7


@dataclass(frozen=True)
class SketchSettings:
    """Opinions of the sketch."""

    landmarks: LandmarkSettings = field(default_factory=LandmarkSettings)
    jambs: JambSettings = field(default_factory=JambSettings)
    tolerance: float = 0.03  # metres the polyline may miss a reading along its beam; larger gives fewer knots


@dataclass(frozen=True, eq=False)
class PrimalSketch:
    """The knots of one contour, counter-clockwise, in the robot's frame.

    kinds: (k,) KnotKind. positions: (k, 2). turns: (k,) counter-clockwise. headings: (k,) bisector to the free space.
    walls: (k, 2) direction of travel along the surface before and after the knot, nan where it was not seen.
    scales: (k, 2) finest and coarsest sigma. covariances: (k, 2, 2). landmark: (k,). real: (k,) whether the edge
    from knot i to i + 1 is surface. readings: (k,) place among the readings. lines: the walls between knots.
    origin: (2,) where the sensor sat.
    """

    kinds: NDArray[np.uint8]
    positions: Floats
    turns: Floats
    headings: Floats
    walls: Floats
    scales: Floats
    covariances: Floats
    landmark: Booleans
    real: Booleans
    readings: Floats
    lines: Lines
    origin: Floats


@dataclass(frozen=True, eq=False)
class KnotColumns:
    """Columns of knots, as in the primal sketch, while they are gathered."""

    kinds: NDArray[np.uint8]
    positions: Floats
    turns: Floats
    headings: Floats
    walls: Floats
    scales: Floats
    covariances: Floats
    readings: Floats


def sketch(contour: Contour, settings: SketchSettings) -> PrimalSketch:
    """Knots and lines of a contour."""
    vertices = contour.vertices
    points, edges = contour.points[vertices], contour.edge_kinds[vertices]
    noise = contour.spread[vertices]
    landmarks = landmark_knots(contour, settings)
    geometry = _geometry(contour, points, edges, landmarks, settings)
    knots = _joined([landmarks, geometry])
    order = np.argsort(knots.readings, kind="stable")
    knots = KnotColumns(*(getattr(knots, name)[order] for name in KnotColumns.__dataclass_fields__))
    return PrimalSketch(
        kinds=knots.kinds,
        positions=knots.positions,
        turns=knots.turns,
        headings=knots.headings,
        walls=knots.walls,
        scales=knots.scales,
        covariances=knots.covariances,
        landmark=~np.isin(knots.kinds, (KnotKind.GEOMETRY, KnotKind.SMOOTH_JOIN)),
        real=_real_edges(knots.readings, edges),
        readings=knots.readings,
        lines=wall_lines(points, knots.readings, _real_edges(knots.readings, edges), noise),
        origin=contour.origin,
    )


def landmark_knots(contour: Contour, settings: SketchSettings) -> KnotColumns:
    """The knots of a contour that may be matched, and its smooth joins; without what only bounds the polyline."""
    vertices = contour.vertices
    points, edges, noise = contour.points[vertices], contour.edge_kinds[vertices], contour.spread[vertices]
    long_enough = 2 * settings.landmarks.least_points
    found = [_corners(points, noise, chain, settings) for chain in chains(edges) if chain.size >= long_enough]
    return _joined([*found, _jambs(contour, points, noise, edges, settings)])


def chains(edges: NDArray[np.uint8]) -> list[Integers]:
    """Runs of vertices joined by real edges (cyclic), as index arrays of at least two."""
    real = edges == EdgeKind.REAL
    n = real.size
    if np.all(real):
        return [np.arange(n)]
    starts = np.flatnonzero(real & ~np.roll(real, 1))
    stops = np.flatnonzero(real & ~np.roll(real, -1)) + 1
    if starts.size and stops[0] <= starts[0]:
        stops = np.roll(stops, -1)
    return [
        np.arange(start, stop + 1 if stop > start else stop + n + 1) % n
        for start, stop in zip(starts, stops, strict=True)
    ]


def _joined(parts: list[KnotColumns]) -> KnotColumns:
    return KnotColumns(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in KnotColumns.__dataclass_fields__)
    )


def _corners(points: Floats, noise: Floats, chain: Integers, settings: SketchSettings) -> KnotColumns:
    knots = chain_knots(points[chain], float(np.mean(noise[chain])), settings.landmarks)
    before = knots.headings - 0.5 * np.pi - 0.5 * knots.turns
    return KnotColumns(
        kinds=knots.kinds,
        positions=knots.positions,
        turns=knots.turns,
        headings=knots.headings,
        walls=np.column_stack([before, before + knots.turns]),
        scales=knots.scales,
        covariances=knots.covariances,
        readings=chain[knots.places].astype(np.float64) + 0.5,
    )


def _jambs(
    contour: Contour, points: Floats, noise: Floats, edges: NDArray[np.uint8], settings: SketchSettings
) -> KnotColumns:
    jambs = find_jambs(points, noise, edges, contour.origin, settings.jambs)
    return KnotColumns(
        kinds=np.where(jambs.bumps, KnotKind.BUMP, KnotKind.JAMB).astype(np.uint8),
        positions=jambs.positions,
        turns=jambs.turns,
        headings=jambs.headings,
        walls=jambs.walls,
        scales=np.full((jambs.turns.size, 2), np.nan),
        covariances=jambs.covariances,
        readings=jambs.vertices.astype(np.float64),
    )


def _geometry(
    contour: Contour, points: Floats, edges: NDArray[np.uint8], landmarks: KnotColumns, settings: SketchSettings
) -> KnotColumns:
    """The vertices that keep the polyline within the tolerance of every reading, where no landmark does already."""
    chosen = bounded_vertices(points, edges == EdgeKind.REAL, contour.origin, settings.tolerance)
    if landmarks.readings.size:
        gap = np.min(np.abs(chosen[:, None] - landmarks.readings[None]), axis=1)
        chosen = chosen[gap > 0.5]
    k = chosen.size
    before = np.roll(points, 1, axis=0)[chosen] - points[chosen]
    after = np.roll(points, -1, axis=0)[chosen] - points[chosen]
    heading_in, heading_out = np.arctan2(-before[:, 1], -before[:, 0]), np.arctan2(after[:, 1], after[:, 0])
    turns = np.pi - np.mod(np.pi - (heading_out - heading_in), 2 * np.pi)
    spread = contour.spread[contour.vertices[chosen]]
    return KnotColumns(
        kinds=np.full(k, KnotKind.GEOMETRY, dtype=np.uint8),
        positions=points[chosen],
        turns=turns,
        headings=np.pi - np.mod(np.pi - (heading_in + 0.5 * turns + 0.5 * np.pi), 2 * np.pi),
        walls=np.full((k, 2), np.nan),
        scales=np.full((k, 2), np.nan),
        covariances=spread[:, None, None] ** 2 * np.eye(2),
        readings=chosen.astype(np.float64),
    )


def _real_edges(readings: Floats, edges: NDArray[np.uint8]) -> Booleans:
    """Whether everything from each knot to the next, cyclically, is surface (k,)."""
    n = edges.size
    fakes = np.concatenate([[0], np.cumsum(np.tile(edges != EdgeKind.REAL, 2))])
    start = np.floor(readings).astype(np.int64)
    stop = np.ceil(np.roll(readings, -1)).astype(np.int64)
    stop = np.where(stop <= start, stop + n, stop)
    return np.asarray(fakes[stop] == fakes[start])
