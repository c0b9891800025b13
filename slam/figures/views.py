"""What single views saw (Flynn 1988, Figs 8–11): boundaries raw and redrawn, sketches, and all views overlaid."""

from collections.abc import Callable

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from shapely import Polygon

from frontend.contour import EdgeKind
from frontend.primal_sketch import KnotKind
from frontend.rigid_motion import transform
from frontend.scan import Floats
from slam.figures.sensing import edges_of_kind
from slam.figures.sheet import (
    FAINT,
    FAKE,
    FREE,
    INK,
    LANDMARK,
    OPENED,
    SKETCH,
    draw_drive,
    framed,
    legend,
    lines,
    patch,
    sheet,
)
from slam.perception import Percept
from slam.story import Story

PANELS = 3  # views shown one by one, spread evenly over the drive
EDGE_STYLES = {
    EdgeKind.REAL: ("surface", INK, "solid"),
    EdgeKind.OCCLUSION: ("filler", FAKE, "dotted"),
    EdgeKind.NO_RETURN: ("no return, or inferred", FAINT, "dotted"),
    EdgeKind.SIDE: ("end of the view", FAINT, "dashed"),
    EdgeKind.DOOR_ARC: ("door arc", OPENED, "solid"),
}


def raw_boundaries(story: Story) -> Figure:
    """The readings as the sensor gave them, joined in order."""
    return _panels(story, _draw_raw, "as the sensor read it")


def redrawn_boundaries(story: Story) -> Figure:
    """The contours after fusion, surface told apart from filler."""
    return _panels(story, _draw_contour, "redrawn")


def sketches(story: Story) -> Figure:
    """Knots and lines of each view; landmark knots with their 2-sigma ellipses."""
    return _panels(story, _draw_sketch, "primal sketch")


def overlaid_views(story: Story) -> Figure:
    """All views at their estimated poses: free space under, surface over."""
    seen = zip(story.percepts, story.poses, strict=True)
    placed = [Polygon(transform(percept.view.boundary, pose)) for percept, pose in seen]
    figure, axes = sheet(f"{len(placed)} views overlaid")
    patches = PatchCollection([patch(outline) for outline in placed], facecolor=FREE, edgecolor="none")
    patches.set_alpha(max(0.02, 0.5 / len(placed) ** 0.5))
    axes.add_collection(patches)
    walls = [
        transform(piece.reshape(-1, 2), pose).reshape(-1, 2, 2)
        for percept, pose in zip(story.percepts, story.poses, strict=True)
        if len(piece := edges_of_kind(percept.contour, EdgeKind.REAL))
    ]
    lines(axes, np.concatenate([np.empty((0, 2, 2)), *walls]), INK, width=0.6)
    draw_drive(axes, story.poses)
    return framed(figure, axes, shapely.get_coordinates(placed))


def _panels(story: Story, draw_view: Callable[[Axes, Percept], None], title: str) -> Figure:
    count = len(story.percepts)
    shown = sorted({int(scan) for scan in np.linspace(0, count - 1, min(PANELS, count)).round()})
    figure = Figure(figsize=(5 * len(shown) + 1.5, 5))
    reach = np.concatenate([story.percepts[scan].raw_ends for scan in shown])
    low, high = reach.min(axis=0), reach.max(axis=0)
    for axes, scan in zip(np.atleast_1d(figure.subplots(1, len(shown))), shown, strict=True):
        draw_view(axes, story.percepts[scan])
        axes.plot(0, 0, "o", color=SKETCH, markersize=5)
        axes.set(title=f"view {scan + 1}, {title}", aspect="equal", xlabel="x (m)")
        axes.set(xlim=(low[0] - 0.3, high[0] + 0.3), ylim=(low[1] - 0.3, high[1] + 0.3))
    figure.axes[0].set_ylabel("y (m)")
    legend(figure.axes)
    return figure


def _draw_raw(axes: Axes, percept: Percept) -> None:
    ring = percept.raw_ends
    axes.add_patch(patch(Polygon(ring), facecolor=FREE, edgecolor=INK, linewidth=0.8))
    lost = np.isinf(percept.fused.raw_ranges)
    axes.plot(*ring[lost].T, "x", color=FAINT, markersize=4, label="no return")


def _draw_contour(axes: Axes, percept: Percept) -> None:
    contour = percept.contour
    axes.add_patch(patch(contour.free_space, facecolor=FREE, edgecolor="none"))
    for kind, (label, ink, style) in EDGE_STYLES.items():
        lines(axes, edges_of_kind(contour, kind), ink, label=label, style=style)
    for jambs in percept.fused.jambs:
        axes.plot(*jambs.T, "o", color=OPENED, markersize=5)


def _draw_sketch(axes: Axes, percept: Percept) -> None:
    knots = percept.sketch
    lines(axes, edges_of_kind(percept.contour, EdgeKind.REAL), FAINT, label="surface")
    lines(axes, knots.lines.ends, SKETCH, label="line", width=1.8)
    for kind in KnotKind:
        chosen = knots.positions[knots.kinds == kind]
        if kind != KnotKind.GEOMETRY:
            label = kind.name.lower().replace("_", " ") if len(chosen) else "_nothing to name"
            axes.plot(*chosen.T, "o", color=f"C{kind.value}", markersize=5, label=label)
    for position, covariance in zip(knots.positions[knots.landmark], knots.covariances[knots.landmark], strict=True):
        axes.add_patch(_ellipse(position, covariance))


def _ellipse(position: Floats, covariance: Floats) -> Ellipse:
    """The 2-sigma ellipse of a knot."""
    variances, directions = np.linalg.eigh(covariance)
    angle = float(np.degrees(np.arctan2(directions[1, 1], directions[0, 1])))
    width, height = 4 * np.sqrt(np.maximum(variances[::-1], 0.0))
    return Ellipse((position[0], position[1]), width, height, angle=angle, fill=False, edgecolor=LANDMARK)
