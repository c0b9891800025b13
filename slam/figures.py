"""The paper's figures (Flynn 1988, Figs 8–13): boundaries raw and redrawn, sketches, views overlaid, the map, paths."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, PathPatch
from matplotlib.path import Path as Outline
from shapely import MultiPolygon, Polygon

from backend.contours import as_polygons
from backend.room_map import MapEdgeKind, RoomMap, Verdict
from backend.view import View
from frontend.contour import EdgeKind
from frontend.primal_sketch import KnotKind
from frontend.rigid_motion import transform
from frontend.scan import Floats
from slam.boundary_scores import distances, edges_of
from slam.figures_of_sensing import edges_of_kind, sensing_figures
from slam.map_scores import MapTruth, real_edges
from slam.perception import Percept
from slam.story import Story

PANELS = 3  # views shown one by one, spread evenly over the drive
DOTS_PER_INCH = 110

FREE, INK, FAINT, FAKE, OPENED, SKETCH = "#dce9f5", "#1b1b1b", "#b5b5b5", "#d98c00", "#009e73", "#0b62a8"
LANDMARK, INFERRED = "#c23b80", "#8a6fb3"
PLANNER_INKS = (("#d55e00", 3.5), ("#0072b2", 1.5))  # the second is drawn over the first
EDGE_STYLES = {
    EdgeKind.REAL: ("surface", INK, "solid"),
    EdgeKind.OCCLUSION: ("filler", FAKE, "dotted"),
    EdgeKind.NO_RETURN: ("no return, or inferred", FAINT, "dotted"),
    EdgeKind.SIDE: ("end of the view", FAINT, "dashed"),
    EdgeKind.DOOR_ARC: ("door arc", OPENED, "solid"),
}

VERDICT_STYLES = {
    Verdict.KEPT: ("surface kept", INK, "solid"),
    Verdict.CONTRADICTED: ("surface others saw through", "#d62728", "solid"),
    Verdict.SEEN_BEHIND: ("line of sight others saw behind", OPENED, "dotted"),
    Verdict.OPEN: ("line of sight nobody saw behind", FAKE, "dashed"),
    Verdict.INFERRED: ("object inferred", INFERRED, "solid"),
}


def draw(story: Story, folder: Path) -> list[str]:
    """Write every figure that the recording allows into `folder` as PNG; their names."""
    folder.mkdir(parents=True, exist_ok=True)
    drawn = {name: figure(story) for name, figure in FIGURES.items()} | sensing_figures(story.percepts)
    for name, figure in drawn.items():
        figure.savefig(folder / f"{name}.png", dpi=DOTS_PER_INCH, bbox_inches="tight")
    return list(drawn)


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
    placed = [Polygon(transform(view.boundary, pose)) for view, pose in _views(story)]
    figure, axes = _sheet(f"{len(placed)} views overlaid")
    patches = PatchCollection([_patch(outline) for outline in placed], facecolor=FREE, edgecolor="none")
    patches.set_alpha(max(0.02, 0.5 / len(placed) ** 0.5))
    axes.add_collection(patches)
    walls = [
        transform(piece.reshape(-1, 2), pose).reshape(-1, 2, 2)
        for percept, pose in zip(story.percepts, story.poses, strict=True)
        if len(piece := edges_of_kind(percept.contour, EdgeKind.REAL))
    ]
    _lines(axes, np.concatenate([np.empty((0, 2, 2)), *walls]), INK, width=0.6)
    _draw_drive(axes, story.poses)
    return _framed(figure, axes, shapely.get_coordinates(placed))


def decisions(story: Story) -> Figure:
    """What became of every piece of every view's boundary: kept, thrown away, or filled in by inference."""
    figure, axes = _sheet("what the merge decided")
    axes.add_patch(_patch(story.room.free, facecolor=FREE, edgecolor="none"))
    for verdict, (label, ink, style) in VERDICT_STYLES.items():
        pieces = [made.piece for made in story.room.decisions if made.verdict == verdict]
        _lines(axes, pieces, ink, label=f"{label}: {len(pieces)}", style=style)
    _draw_drive(axes, story.poses)
    return _framed(figure, axes, shapely.get_coordinates(story.room.free))


def merged_map(story: Story) -> Figure:
    """The room map with every edge's kind, doors, obstacles, landmarks and the drive."""
    figure, axes = _sheet("the merged map")
    _draw_room(axes, story.room)
    _draw_drive(axes, story.poses)
    if story.next_view is not None:
        look = story.next_view
        axes.plot(
            *look.pose[:2], "*", color=FAKE, markersize=13, label=f"look here next: {look.gain:.1f} m of frontier"
        )
        axes.plot(*look.frontier.T, ".", color=FAKE, markersize=3)
    axes.plot(*story.landmarks.T, "+", color=LANDMARK, markersize=5, label=f"{len(story.landmarks)} landmarks")
    return _framed(figure, axes, shapely.get_coordinates(story.room.free))


def planned_paths(story: Story) -> Figure:
    """What each planner found from the first pose to the far end of the map's safety layer."""
    figure, axes = _sheet("planned paths")
    _draw_room(axes, story.room)
    for (name, poses), (ink, width) in zip(story.paths.items(), PLANNER_INKS, strict=False):
        axes.plot(poses[:, 0], poses[:, 1], "-", color=ink, linewidth=width, label=name)
        axes.plot(*poses[0, :2], "o", color=ink, markersize=6)
        axes.plot(*poses[-1, :2], "s", color=ink, markersize=6)
    return _framed(figure, axes, shapely.get_coordinates(story.room.free))


def map_errors(room: RoomMap, truth: MapTruth) -> Figure:
    """The map over the true plan: false free ground, ground missed, and how far off each claimed edge lies."""
    figure, axes = _sheet("the map against the true plan")
    for ground, ink, label in (
        (truth.free, "#eeeeee", "true free ground"),
        (room.free.intersection(truth.free), FREE, "of it in the map"),
        (room.free.difference(truth.free), "#d62728", "false free"),
        (truth.seen.difference(room.free), "#1f5fd0", "missed free"),
    ):
        axes.add_patch(
            _patch(as_polygons(ground), facecolor=ink, edgecolor="none", label=f"{label}, {ground.area:.2f} m²")
        )
    edges = real_edges(room)
    if len(edges):
        off = distances(edges.mean(axis=1), edges_of(truth.free))
        walls = LineCollection(list(edges), array=100 * off, cmap="viridis", clim=(0, 20), linewidths=1.6)
        says: dict[str, Any] = {
            "label": "claimed edge off the true one (cm)",
            "extend": "max",
            "location": "bottom",
            "shrink": 0.6,
        }
        figure.colorbar(axes.add_collection(walls), ax=axes, **says)
    return _framed(figure, axes, shapely.get_coordinates([room.free, truth.seen]))


def draw_errors(room: RoomMap, truth: MapTruth, folder: Path) -> Path:
    """Write the error picture into `folder` as PNG; where it is."""
    folder.mkdir(parents=True, exist_ok=True)
    picture = folder / "7_errors.png"
    map_errors(room, truth).savefig(picture, dpi=DOTS_PER_INCH, bbox_inches="tight")
    return picture


FIGURES: dict[str, Callable[[Story], Figure]] = {
    "1_raw_boundaries": raw_boundaries,
    "2_redrawn_boundaries": redrawn_boundaries,
    "3_sketches": sketches,
    "4_overlaid_views": overlaid_views,
    "4b_decisions": decisions,
    "5_map": merged_map,
    "6_paths": planned_paths,
}


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
    _legend(figure.axes)
    return figure


def _draw_raw(axes: Axes, percept: Percept) -> None:
    ring = percept.raw_ends
    axes.add_patch(_patch(Polygon(ring), facecolor=FREE, edgecolor=INK, linewidth=0.8))
    lost = np.isinf(percept.fused.raw_ranges)
    axes.plot(*ring[lost].T, "x", color=FAINT, markersize=4, label="no return")


def _draw_contour(axes: Axes, percept: Percept) -> None:
    contour = percept.contour
    axes.add_patch(_patch(contour.free_space, facecolor=FREE, edgecolor="none"))
    for kind, (label, ink, style) in EDGE_STYLES.items():
        _lines(axes, edges_of_kind(contour, kind), ink, label=label, style=style)
    for jambs in percept.fused.jambs:
        axes.plot(*jambs.T, "o", color=OPENED, markersize=5)


def _draw_sketch(axes: Axes, percept: Percept) -> None:
    knots = percept.sketch
    _lines(axes, edges_of_kind(percept.contour, EdgeKind.REAL), FAINT, label="surface")
    _lines(axes, knots.lines.ends, SKETCH, label="line", width=1.8)
    for kind in KnotKind:
        chosen = knots.positions[knots.kinds == kind]
        if kind != KnotKind.GEOMETRY:
            label = kind.name.lower().replace("_", " ") if len(chosen) else "_nothing to name"
            axes.plot(*chosen.T, "o", color=f"C{kind.value}", markersize=5, label=label)
    for position, covariance in zip(knots.positions[knots.landmark], knots.covariances[knots.landmark], strict=True):
        axes.add_patch(_ellipse(position, covariance))


def _draw_room(axes: Axes, room: RoomMap) -> None:
    for part in room.free.geoms:
        axes.add_patch(_patch(part, facecolor=FREE, edgecolor="none"))
    for kind, label, ink, style in (
        (MapEdgeKind.REAL, "wall", INK, "solid"),
        (MapEdgeKind.FRONTIER, "frontier", FAKE, "dashed"),
    ):
        pieces = np.array([[edge.start, edge.end] for edge in room.edges if edge.kind == kind]).reshape(-1, 2, 2)
        _lines(axes, pieces, ink, label=label, style=style, width=1.4)
    for inferred, label in ((False, "obstacle"), (True, "inferred obstacle")):
        outlines = [body.outline for body in room.obstacles if body.inferred is inferred]
        for number, outline in enumerate(outlines):
            ink = INFERRED if inferred else INK
            says = {"label": label} if number == 0 else {}
            axes.add_patch(_patch(outline, facecolor=ink, alpha=0.35, edgecolor=ink, **says))
    _lines(axes, np.array([door.jambs for door in room.doors]).reshape(-1, 2, 2), OPENED, label="door", width=3)


def _draw_drive(axes: Axes, poses: Floats) -> None:
    axes.plot(poses[:, 0], poses[:, 1], ".-", color=SKETCH, linewidth=0.6, markersize=2, label="drive")
    axes.plot(*poses[0, :2], "o", color=SKETCH, markersize=5)


def _sheet(title: str) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(9, 7))
    axes = figure.subplots()
    axes.set(title=title, aspect="equal", xlabel="x (m)", ylabel="y (m)")
    return figure, axes


def _framed(figure: Figure, axes: Axes, corners: Floats) -> Figure:
    if len(corners):
        low, high = corners.min(axis=0), corners.max(axis=0)
        axes.set(xlim=(low[0] - 0.3, high[0] + 0.3), ylim=(low[1] - 0.3, high[1] + 0.3))
    _legend([axes])
    return figure


def _legend(panels: list[Axes]) -> None:
    """One legend for all panels, beside the last one, where it hides nothing."""
    named = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if named:
        panels[-1].legend(named.values(), named.keys(), loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8)


def _views(story: Story) -> list[tuple[View, Floats]]:
    return [(percept.view, pose) for percept, pose in zip(story.percepts, story.poses, strict=True)]


def _lines(
    axes: Axes, pieces: Floats | list[Floats], ink: str, *, label: str = "", style: str = "solid", width: float = 1.2
) -> None:
    if len(pieces):
        lines = LineCollection(list(pieces), colors=ink, linestyles=style, linewidths=width, label=label or None)
        axes.add_collection(lines)


def _patch(shape: Polygon | MultiPolygon, **looks: object) -> PathPatch:
    if shape.is_empty:
        return PathPatch(Outline(np.zeros((1, 2))), **looks)
    rings: Iterable[shapely.LinearRing] = [ring for part in _parts(shape) for ring in (part.exterior, *part.interiors)]
    return PathPatch(Outline.make_compound_path(*(Outline(np.asarray(r.coords), closed=True) for r in rings)), **looks)


def _parts(shape: Polygon | MultiPolygon) -> list[Polygon]:
    """Polygons with holes against the sense of their shells, as filling demands."""
    return [part for part in shapely.get_parts(shapely.orient_polygons(shape)) if isinstance(part, Polygon)]


def _ellipse(position: Floats, covariance: Floats) -> Ellipse:
    """The 2-sigma ellipse of a knot."""
    variances, directions = np.linalg.eigh(covariance)
    angle = float(np.degrees(np.arctan2(directions[1, 1], directions[0, 1])))
    width, height = 4 * np.sqrt(np.maximum(variances[::-1], 0.0))
    return Ellipse((position[0], position[1]), width, height, angle=angle, fill=False, edgecolor=LANDMARK)
