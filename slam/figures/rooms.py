"""The merged map (Flynn 1988, Figs 12–13): what the merge decided, the map, paths on it, and its errors."""

from typing import Any

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from backend.contours import as_polygons
from backend.room_map import MapEdgeKind, RoomMap, Verdict
from slam.figures.sheet import (
    FAKE,
    FREE,
    INFERRED,
    INK,
    LANDMARK,
    OPENED,
    draw_drive,
    framed,
    lines,
    patch,
    sheet,
)
from slam.scores.boundaries import distances, edges_of
from slam.scores.maps import MapTruth, real_edges
from slam.story import Story

PLANNER_INKS = (("#d55e00", 3.5), ("#0072b2", 1.5))  # the second is drawn over the first
VERDICT_STYLES = {
    Verdict.KEPT: ("surface kept", INK, "solid"),
    Verdict.CONTRADICTED: ("surface others saw through", "#d62728", "solid"),
    Verdict.SEEN_BEHIND: ("line of sight others saw behind", OPENED, "dotted"),
    Verdict.OPEN: ("line of sight nobody saw behind", FAKE, "dashed"),
    Verdict.INFERRED: ("object inferred", INFERRED, "solid"),
}


def decisions(story: Story) -> Figure:
    """What became of every piece of every view's boundary: kept, thrown away, or filled in by inference."""
    figure, axes = sheet("what the merge decided")
    axes.add_patch(patch(story.room.free, facecolor=FREE, edgecolor="none"))
    for verdict, (label, ink, style) in VERDICT_STYLES.items():
        pieces = [made.piece for made in story.room.decisions if made.verdict == verdict]
        lines(axes, pieces, ink, label=f"{label}: {len(pieces)}", style=style)
    draw_drive(axes, story.poses)
    return framed(figure, axes, shapely.get_coordinates(story.room.free))


def merged_map(story: Story) -> Figure:
    """The room map with every edge's kind, doors, obstacles, landmarks and the drive."""
    figure, axes = sheet("the merged map")
    _draw_room(axes, story.room)
    draw_drive(axes, story.poses)
    if story.next_view is not None:
        look = story.next_view
        axes.plot(
            *look.pose[:2], "*", color=FAKE, markersize=13, label=f"look here next: {look.gain:.1f} m of frontier"
        )
        axes.plot(*look.frontier.T, ".", color=FAKE, markersize=3)
    axes.plot(*story.landmarks.T, "+", color=LANDMARK, markersize=5, label=f"{len(story.landmarks)} landmarks")
    return framed(figure, axes, shapely.get_coordinates(story.room.free))


def planned_paths(story: Story) -> Figure:
    """What each planner found from the first pose to the far end of the map's safety layer."""
    figure, axes = sheet("planned paths")
    _draw_room(axes, story.room)
    for (name, poses), (ink, width) in zip(story.paths.items(), PLANNER_INKS, strict=False):
        axes.plot(poses[:, 0], poses[:, 1], "-", color=ink, linewidth=width, label=name)
        axes.plot(*poses[0, :2], "o", color=ink, markersize=6)
        axes.plot(*poses[-1, :2], "s", color=ink, markersize=6)
    return framed(figure, axes, shapely.get_coordinates(story.room.free))


def map_errors(room: RoomMap, truth: MapTruth) -> Figure:
    """The map over the true plan: false free ground, ground missed, and how far off each claimed edge lies."""
    figure, axes = sheet("the map against the true plan")
    for ground, ink, label in (
        (truth.free, "#eeeeee", "true free ground"),
        (room.free.intersection(truth.free), FREE, "of it in the map"),
        (room.free.difference(truth.free), "#d62728", "false free"),
        (truth.seen.difference(room.free), "#1f5fd0", "missed free"),
    ):
        axes.add_patch(
            patch(as_polygons(ground), facecolor=ink, edgecolor="none", label=f"{label}, {ground.area:.2f} m²")
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
    return framed(figure, axes, shapely.get_coordinates([room.free, truth.seen]))


def _draw_room(axes: Axes, room: RoomMap) -> None:
    for part in room.free.geoms:
        axes.add_patch(patch(part, facecolor=FREE, edgecolor="none"))
    for kind, label, ink, style in (
        (MapEdgeKind.REAL, "wall", INK, "solid"),
        (MapEdgeKind.FRONTIER, "frontier", FAKE, "dashed"),
    ):
        pieces = np.array([[edge.start, edge.end] for edge in room.edges if edge.kind == kind]).reshape(-1, 2, 2)
        lines(axes, pieces, ink, label=label, style=style, width=1.4)
    for inferred, label in ((False, "obstacle"), (True, "inferred obstacle")):
        outlines = [body.outline for body in room.obstacles if body.inferred is inferred]
        for number, outline in enumerate(outlines):
            ink = INFERRED if inferred else INK
            says = {"label": label} if number == 0 else {}
            axes.add_patch(patch(outline, facecolor=ink, alpha=0.35, edgecolor=ink, **says))
    lines(axes, np.array([door.jambs for door in room.doors]).reshape(-1, 2, 2), OPENED, label="door", width=3)
