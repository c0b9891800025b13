"""Perception: everything the front end makes of one scan, kept together for the stages after it."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from backend.arcs import Arcs
from backend.landmark_map import Knots
from backend.view import View
from frontend.contour import Contour, ContourSettings, EdgeKind, filled, outline
from frontend.fusion import FusedScan, FusionSettings, fuse
from frontend.landmarks import corners
from frontend.primal_sketch import PrimalSketch, SketchSettings, sketch
from frontend.range_arcs import ArcSettings, range_arcs
from frontend.rigid_motion import transform
from frontend.scan import Floats, Scan
from frontend.surface import Surface
from slam.wide_beam import wide_beam


@dataclass(frozen=True)
class FrontendSettings:
    """The settings of the front end, stage by stage."""

    fusion: FusionSettings = field(default_factory=FusionSettings)
    contour: ContourSettings = field(default_factory=ContourSettings)
    sketch: SketchSettings = field(default_factory=SketchSettings)
    arcs: ArcSettings = field(default_factory=ArcSettings)


@dataclass(frozen=True, eq=False)
class Percept:
    """One scan, fused and outlined; surface is what registration uses. All in the robot's frame.

    Poses need no more: what else there is to see is made when somebody looks.
    """

    fused: FusedScan
    outline: Contour
    surface: Surface
    settings: FrontendSettings

    @property
    def scan(self) -> Scan:
        """The scan as it was read."""
        return self.fused.scan

    @property
    def raw_ends(self) -> Floats:
        """(n, 2) ends of the readings as the sensor gave them; without echo, as far as fusion calls it free."""
        fused = self.fused
        ranges = np.where(np.isfinite(fused.raw_ranges), fused.raw_ranges, fused.ranges)
        ends = ranges[:, None] * np.column_stack([np.cos(fused.bearings), np.sin(fused.bearings)])
        return transform(ends, np.array(fused.scan.sensor.mount))

    @cached_property
    def contour(self) -> Contour:
        """The outline with its filler points."""
        return filled(self.outline, self.settings.contour.filler_spacing)

    @cached_property
    def sketch(self) -> PrimalSketch:
        """The primal sketch of the contour."""
        return sketch(self.outline, self.settings.sketch)

    @property
    def knots(self) -> Knots:
        """The corners of the sketch, both of whose sides were seen: a half-seen corner moves with the viewpoint."""
        traced = self.outline
        found = corners(
            traced.points, traced.edge_kinds == EdgeKind.REAL, traced.spread, self.settings.sketch.landmarks
        )
        return Knots(found.positions, found.turns, found.headings, found.covariances)

    @cached_property
    def arcs(self) -> Arcs | None:
        """The regions of constant depth of a sonar that turns with the robot's centre; None for other sensors."""
        sensor = self.scan.sensor
        if sensor.kind != "sonar_infrared" or any(sensor.mount) or not self.scan.full_turn:
            return None
        found = range_arcs(self.scan, self.settings.arcs)
        return Arcs(
            found.ranges, found.spread, found.wall_bearings, found.wall_spreads, found.starts, found.stops,
            found.edge_bearings, found.edge_spreads, found.firm, found.rising,
        )  # fmt: skip

    @property
    def view(self) -> View:
        """What the scan says of the room, for merging."""
        return View(
            self.outline.points,
            self.outline.edge_kinds,
            self.outline.spread,
            self.fused.origin,
            self.fused.jambs,
            wide_beam(self.outline, self.fused),
        )


def perceive(scan: Scan, settings: FrontendSettings) -> Percept:
    """Run the front end on one scan."""
    fused = fuse(scan, settings.fusion)
    traced = outline(fused, settings.contour)
    return Percept(fused, traced, traced.surface(), settings)
