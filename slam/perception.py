"""Perception: everything the front end makes of one scan, kept together for the stages after it."""

from dataclasses import dataclass, field

import numpy as np

from backend.landmark_map import Knots
from backend.view import View
from frontend.contour import Contour, ContourSettings, trace
from frontend.fusion import FusedScan, FusionSettings, fuse
from frontend.primal_sketch import PrimalSketch, SketchSettings, sketch
from frontend.rigid_motion import transform
from frontend.scan import Floats, Scan
from frontend.surface import Surface


@dataclass(frozen=True)
class FrontendSettings:
    """The settings of the front end, stage by stage."""

    fusion: FusionSettings = field(default_factory=FusionSettings)
    contour: ContourSettings = field(default_factory=ContourSettings)
    sketch: SketchSettings = field(default_factory=SketchSettings)


@dataclass(frozen=True, eq=False)
class Percept:
    """One scan, fused, traced and sketched; surface is what registration uses. All in the robot's frame."""

    fused: FusedScan
    contour: Contour
    sketch: PrimalSketch
    surface: Surface

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

    @property
    def knots(self) -> Knots:
        """The landmark knots of the sketch whose both sides were seen: a half-seen corner moves with the viewpoint."""
        kept = self.sketch.landmark & ~np.isnan(self.sketch.walls).any(axis=1)
        return Knots(
            self.sketch.positions[kept],
            self.sketch.turns[kept],
            self.sketch.headings[kept],
            self.sketch.covariances[kept],
        )

    @property
    def view(self) -> View:
        """What the scan says of the room, for merging."""
        vertices = self.contour.vertices
        return View(
            self.contour.points[vertices],
            self.contour.edge_kinds[vertices],
            self.contour.spread[vertices],
            self.fused.origin,
            self.fused.jambs,
        )


def perceive(scan: Scan, settings: FrontendSettings) -> Percept:
    """Run the front end on one scan."""
    fused = fuse(scan, settings.fusion)
    contour = trace(fused, settings.contour)
    return Percept(fused, contour, sketch(contour, settings.sketch), contour.surface())
