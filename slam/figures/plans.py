"""What the planners built and found: cones with their spines, the boxes of configuration space, and the paths."""

from io import BytesIO

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from numpy.typing import NDArray

from frontend.scan import Floats
from planners.cells import EMPTY, FULL, MIXED, SMALL
from planners.path import Answer, Cells
from planners.robot import Robot
from planners.world import World

FREE, INK, PATH, ROBOT, CONE, SPINE = "#ffffff", "#1b1b1b", "#d55e00", "#d55e00", "#0b62a8", "#0b62a8"
KINDS = ((EMPTY, "free", "#009e73"), (MIXED, "partly free", "#e8b800"), (SMALL, "too small to cut", "#d98c00"))
COLLIDING, GAP = "#555555", "#c2002f"
GHOSTS = 12  # placements of the robot drawn along a path
DOTS_PER_INCH = 130


def draw_plans(answers: dict[str, Answer], world: World, robot: Robot, ends: tuple[Floats, Floats]) -> Figure:
    """One panel per planner: the world, what it built there, and its path between two poses (3,)."""
    figure = Figure(figsize=(8 * len(answers) + 1, 7.5), layout="constrained")
    for axes, (name, answer) in zip(np.atleast_1d(figure.subplots(1, len(answers))), answers.items(), strict=True):
        _draw_world(axes, world)
        if answer.cells is not None:
            _draw_cells(axes, answer.cells, robot)
        _draw_cones(axes, answer)
        _draw_path(axes, answer, robot)
        _draw_gap(axes, answer)
        for place, sign, label in zip(ends, "os", ("start", "goal"), strict=True):
            axes.plot(*place[:2], sign, color=INK, markersize=6, label=label)
        path = answer.path
        says = answer.kind if path is None else f"{path.length:.2f} m, clearance {path.clearance:.3f} m"
        axes.set(title=f"{name}: {says}", aspect="equal", xlabel="x (m)", ylabel="y (m)")
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=4, fontsize=8)
    return figure


def png_of(figure: Figure) -> bytes:
    """The figure as a PNG file holds it."""
    buffer = BytesIO()
    figure.savefig(buffer, dpi=DOTS_PER_INCH, format="png")
    return buffer.getvalue()


def _draw_world(axes: Axes, world: World) -> None:
    left, bottom, right, top = world.bounds
    margin = 0.02 * max(right - left, top - bottom)
    axes.set(xlim=(left - margin, right + margin), ylim=(bottom - margin, top + margin), facecolor="#d9d9d9")
    rings = [np.asarray(ring.coords) for part in world.free.geoms for ring in (part.exterior, *part.interiors)]
    outline = Outline.make_compound_path(*(Outline(ring, closed=True) for ring in rings))
    axes.add_patch(PathPatch(outline, facecolor=FREE, edgecolor=INK, linewidth=1.0))


def _draw_cones(axes: Axes, answer: Answer) -> None:
    if answer.cones:
        outlines = [cone.outline for cone in answer.cones]
        strength = min(0.12, 1.2 / len(outlines))
        axes.add_collection(PolyCollection(outlines, facecolors=CONE, alpha=strength, linewidths=0))
        axes.add_collection(
            PolyCollection(outlines, facecolors="none", edgecolors=CONE, alpha=strength, linewidths=0.4)
        )
        spines = [cone.spine for cone in answer.cones]
        width = max(0.15, min(0.8, 80 / len(spines)))
        axes.add_collection(LineCollection(spines, colors=SPINE, linewidths=width, label=f"{len(spines)} spines"))


def _draw_cells(axes: Axes, cells: Cells, robot: Robot) -> None:
    """Boxes seen along the axis of headings: the more headings a box holds, the stronger its ink."""
    period = 2 * np.pi / robot.symmetry
    for label, name, ink in ((FULL, "colliding throughout", COLLIDING), *KINDS):
        kept = cells.labels == label
        if kept.any():
            shares = (cells.highs[kept, 2] - cells.lows[kept, 2]) / period
            boxes = _rectangles(cells.lows[kept, :2], cells.highs[kept, :2])
            inks = np.clip(0.5 * shares, 0.01, 0.5)
            patches = PolyCollection(list(boxes), facecolors=ink, alpha=inks, linewidths=0, rasterized=True)
            axes.add_collection(patches)
            axes.plot([], [], "s", color=ink, label=f"{int(kept.sum())} boxes {name}")
    seen = cells.labels == EMPTY
    edges = _rectangles(cells.lows[seen, :2], cells.highs[seen, :2])
    axes.add_collection(PolyCollection(list(edges), facecolors="none", edgecolors=INK, linewidths=0.1, alpha=0.25))


def _rectangles(lows: Floats, highs: Floats) -> Floats:
    """Corners (n, 4, 2) of boxes (n, 2)."""
    x0, y0, x1, y1 = lows[:, 0], lows[:, 1], highs[:, 0], highs[:, 1]
    return np.stack([np.stack(pair, axis=1) for pair in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))], axis=1)


def _draw_path(axes: Axes, answer: Answer, robot: Robot) -> None:
    if answer.path is None:
        return
    poses = answer.path.poses
    axes.plot(poses[:, 0], poses[:, 1], "-", color=PATH, linewidth=1.6, label="path")
    for pose in _ghosts(poses):
        for part in shapely.get_parts(robot.at(pose)):
            ring = np.asarray(part.exterior.coords)
            axes.fill(*ring.T, facecolor=ROBOT, edgecolor=ROBOT, alpha=0.25, linewidth=0.6)


def _draw_gap(axes: Axes, answer: Answer) -> None:
    """The two walls that a proof names, with a ring around the place between them that is too narrow."""
    if answer.gap is None:
        return
    label = f"{answer.gap.width:.3g} m wide, {answer.gap.needed:.3g} m needed"
    axes.add_collection(LineCollection(list(answer.gap.edges), colors=GAP, linewidths=3, label=label, zorder=5))
    axes.plot(*answer.gap.place, "o", markersize=22, markerfacecolor="none", markeredgecolor=GAP, markeredgewidth=2)


def _ghosts(poses: Floats) -> NDArray[np.float64]:
    """Poses (k, 3) spread evenly over a motion, turns counting as well."""
    moves = np.diff(poses, axis=0)
    lengths = np.hypot(moves[:, 0], moves[:, 1])
    travelled = np.concatenate([[0.0], np.cumsum(lengths + 1e-3 * lengths.sum() * np.abs(moves[:, 2]))])
    places = np.linspace(0, travelled[-1], GHOSTS)
    return np.stack([np.interp(places, travelled, poses[:, axis]) for axis in range(3)], axis=1)
