"""The contour: readings joined by filler points into one connected boundary (Flynn 1988, §3.2).

Every point keeps where it came from, and every edge says whether it is surface or only a line of sight.
"""

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from frontend.compiled import compiled
from frontend.fusion import FusedScan, ReadingKind
from frontend.rigid_motion import transform
from frontend.scan import Booleans, Floats, Integers
from frontend.surface import Surface, fit_reaches, line_fits


class ContourKind(IntEnum):
    """Where a point of the contour came from."""

    MEASURED = 0
    FILLER = 1
    NO_RETURN = 2
    DOOR_ARC = 3
    SIDE = 4
    REJECTED = 5
    INFERRED = 6


class EdgeKind(IntEnum):
    """Why two points of the contour are joined."""

    REAL = 0
    OCCLUSION = 1
    NO_RETURN = 2
    SIDE = 3
    DOOR_ARC = 4


KINDS = np.array(
    [ContourKind[kind.name] for kind in sorted(ReadingKind)], dtype=np.uint8
)  # of points, by the reading's
MOST_PACES = 2.5  # how many times its own length a pair of readings may be continued to foretell the next


@dataclass(frozen=True)
class ContourSettings:
    """Opinions of the contour."""

    filler_spacing: float = 0.1  # metres between filler points; larger is coarser and cheaper
    least_grazing: float = 0.5  # radians a surface leaves the beam at; larger calls more steep walls occlusions
    noise_gate: float = 4.0  # standard deviations; larger joins more depth steps into surfaces
    longest_gap: float = 2.0  # metres two readings of one straight wall may lie apart; larger trusts bare grazing walls
    surface_reach: int = 3  # beams to each side of a line fit at least; larger smooths more and rounds corners
    surface_sureness: float = 0.06  # radians to which a fit should know its direction; smaller fits longer stretches
    surface_widest: float = 0.2  # metres to each side of a fit at most beyond that; larger smooths fine scans more
    surface_thickness: float = 0.04  # metres at least; larger keeps rougher surfaces for registration


@dataclass(frozen=True, eq=False)
class Contour:
    """The boundary of the free space of one scan, counter-clockwise, in the robot's frame.

    points: (m, 2). kinds: (m,) ContourKind. edge_kinds: (m,) EdgeKind of the edge from point i to i + 1, cyclic.
    reading: (m,) index into the scan; fillers and the sensor's origin carry the reading before them.
    normals: (m, 2) facing the sensor on measured surface, else nan.
    spread: (m,) standard deviation along the beam; thickness: (m,) of the surface around it, and offset: (m,)
    how far before it, along the normal, that surface runs, else nan; metres.
    vertices: (v,) the points that are no filler: the same boundary with fewer points.
    """

    points: Floats
    kinds: NDArray[np.uint8]
    edge_kinds: NDArray[np.uint8]
    reading: Integers
    normals: Floats
    spread: Floats
    thickness: Floats
    offset: Floats
    origin: Floats
    surface_thickness: float

    @property
    def arc_length(self) -> Floats:
        """(m,) metres from the first point."""
        return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(self.points, axis=0), axis=1))])

    @property
    def vertices(self) -> Integers:
        """Indices of the points that are no filler."""
        return np.flatnonzero(self.kinds != ContourKind.FILLER)

    @property
    def free_space(self) -> Polygon:
        """The star-shaped polygon inside the contour, in the robot's frame."""
        return Polygon(self.points[self.vertices])

    def surface(self) -> Surface:
        """The measured points with a thin line through them, for registration."""
        kept = np.flatnonzero(self.thickness <= self.surface_thickness)
        return Surface(
            self.points[kept] + self.normals[kept] * self.offset[kept, None],
            self.normals[kept],
            np.maximum(self.thickness[kept], self._across(kept)),
            self.reading[kept],
        )

    def _across(self, kept: Integers) -> Floats:
        """The noise along the beam, seen across the surface."""
        beams, normals = self.points[kept] - self.origin, self.normals[kept]
        before = beams[:, 0] * normals[:, 0] + beams[:, 1] * normals[:, 1]
        return np.asarray(self.spread[kept] * np.abs(before) / np.hypot(beams[:, 0], beams[:, 1]))


def trace(fused: FusedScan, settings: ContourSettings) -> Contour:
    """Join the readings in order, say of every edge what it is, and fill the gaps."""
    return filled(outline(fused, settings), settings.filler_spacing)


def outline(fused: FusedScan, settings: ContourSettings) -> Contour:
    """The contour without its filler points."""
    ends = fused.ranges[:, None] * np.column_stack([np.cos(fused.bearings), np.sin(fused.bearings)])
    edges = _edges_between(fused, ends, settings)
    reaches = fit_reaches(
        fused.scan.usual_step, fused.ranges, fused.spread,
        settings.surface_sureness, settings.surface_reach, settings.surface_widest,
    )  # fmt: skip
    normals, thickness, offset = line_fits(ends, edges == EdgeKind.REAL, reaches, np.zeros(2))
    kinds, readings = KINDS[fused.kinds], np.arange(ends.shape[0])
    spread = np.hypot(fused.spread, fused.doubt)
    if not fused.scan.full_turn:  # the view ends at the sensor, on both sides
        ends, kinds = np.vstack([ends, np.zeros(2)]), np.append(kinds, np.uint8(ContourKind.SIDE))
        edges, readings = np.append(edges, np.uint8(EdgeKind.SIDE)), np.append(readings, readings[-1])
        spread, thickness = np.append(spread, 0.0), np.append(thickness, np.nan)
        offset = np.append(offset, np.nan)
        normals = np.vstack([normals, np.full(2, np.nan)])
    mount = np.array(fused.scan.sensor.mount)
    return Contour(
        points=transform(ends, mount),
        kinds=kinds,
        edge_kinds=edges,
        reading=readings,
        normals=transform(normals, np.array([0.0, 0.0, mount[2]])),
        spread=spread,
        thickness=thickness,
        offset=offset,
        origin=mount[:2],
        surface_thickness=max(settings.surface_thickness, 2 * fused.scan.sensor.range_noise),
    )


def filled(outline: Contour, spacing: float) -> Contour:
    """The same boundary with filler points at most `spacing` metres apart."""
    fillers = _filler_counts(outline.points, outline.edge_kinds, spacing)
    owner = np.repeat(np.arange(outline.points.shape[0]), fillers + 1)
    step = np.arange(owner.size) - np.repeat(np.cumsum(fillers + 1) - fillers - 1, fillers + 1)
    share = (step / (fillers[owner] + 1))[:, None]
    following = np.roll(outline.points, -1, axis=0)[owner]
    return replace(
        outline,
        points=(1 - share) * outline.points[owner] + share * following,
        kinds=np.where(step == 0, outline.kinds[owner], ContourKind.FILLER).astype(np.uint8),
        edge_kinds=outline.edge_kinds[owner],
        reading=outline.reading[owner],
        normals=np.where((step == 0)[:, None], outline.normals[owner], np.nan),
        spread=outline.spread[owner],
        thickness=np.where(step == 0, outline.thickness[owner], np.nan),
        offset=np.where(step == 0, outline.offset[owner], np.nan),
    )


def _filler_counts(corners: Floats, edges: NDArray[np.uint8], spacing: float) -> Integers:
    """Fillers (n,) after each corner: none along the sides of the view, which are no boundary of anything."""
    lengths = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    counts: Integers = np.maximum(np.ceil(lengths / spacing) - 1, 0).astype(np.int64)
    counts[edges == EdgeKind.SIDE] = 0
    return counts


def _edges_between(fused: FusedScan, ends: Floats, settings: ContourSettings) -> NDArray[np.uint8]:
    """EdgeKind (n,) of the edge from each reading to the next; the last one closes the turn or is a side."""
    continuous = surface_steps(
        fused.bearings, ends, fused.spread * settings.noise_gate, settings.least_grazing, settings.longest_gap
    )
    return _edge_kinds(fused.kinds, continuous, fused.scan.full_turn)


@compiled
def _edge_kinds(kinds: NDArray[np.uint8], continuous: Booleans, full_turn: bool) -> NDArray[np.uint8]:
    """EdgeKind (n,) by the ReadingKind (n,) at both ends, and whether (n,) one surface can hold both."""
    n = kinds.size
    edges = np.full(n, EdgeKind.OCCLUSION, dtype=np.uint8)
    for i in range(n):
        here, there = kinds[i], kinds[(i + 1) % n]
        if here == ReadingKind.DOOR_ARC and there == ReadingKind.DOOR_ARC:
            edges[i] = EdgeKind.DOOR_ARC
        # No surface answered from there.
        elif here in (ReadingKind.NO_RETURN, ReadingKind.INFERRED) or there in (
            ReadingKind.NO_RETURN,
            ReadingKind.INFERRED,
        ):
            edges[i] = EdgeKind.NO_RETURN
        elif continuous[i] and here == ReadingKind.MEASURED and there == ReadingKind.MEASURED:
            edges[i] = EdgeKind.REAL
    if not full_turn:
        edges[n - 1] = EdgeKind.SIDE
    return edges


@compiled
def surface_steps(bearings: Floats, ends: Floats, gates: Floats, grazing: float, longest: float) -> Booleans:
    """Whether one surface can hold reading i and the next (n,), by geometry.

    Either the step between the two leaves the beam at more than the grazing angle (after Borges & Aldon 2004), noise
    apart, or a grazing wall: the line through the two readings on one side foretells the step within its noise.
    """
    n = bearings.size
    joined = np.zeros(n, dtype=np.bool_)
    for i in range(n):
        j = (i + 1) % n
        near, far = np.hypot(ends[i, 0], ends[i, 1]), np.hypot(ends[j, 0], ends[j, 1])
        angle = (bearings[j] - bearings[i]) % (2 * np.pi)
        nearer = min(near, far)
        reach = nearer * np.sin(angle) / np.sin(grazing - angle) if angle < grazing else np.inf
        step = np.hypot(ends[j, 0] - ends[i, 0], ends[j, 1] - ends[i, 1])
        if angle < 0.5 * np.pi and step <= min(reach, longest) + gates[i]:
            joined[i] = True
        elif step <= longest:
            before, after = (i - 1) % n, (j + 1) % n
            joined[i] = _foretold(ends, before, i, j, gates[i]) or _foretold(ends, after, j, i, gates[j])
    return joined


@compiled
def _foretold(ends: Floats, before: int, here: int, there: int, gate: float) -> bool:
    """Whether the line from `before` through `here` meets the beam to `there` within the gate and its leverage."""
    dx, dy = ends[here, 0] - ends[before, 0], ends[here, 1] - ends[before, 1]
    reach = np.hypot(ends[there, 0], ends[there, 1])
    bx, by = ends[there, 0] / reach, ends[there, 1] / reach
    across = dx * by - dy * bx
    length = np.hypot(dx, dy)
    if abs(across) < 1e-9 or length < 1e-9:
        return False
    foreseen = (dx * ends[here, 1] - dy * ends[here, 0]) / across
    leverage = 1.0 + np.hypot(ends[there, 0] - ends[here, 0], ends[there, 1] - ends[here, 1]) / length
    return bool(foreseen > 0 and abs(foreseen - reach) <= gate * leverage and leverage < 1.0 + MOST_PACES)
