"""A sheet to draw on: axes in metres, polygons with holes, line pieces, one legend, and the inks all figures share."""

from collections.abc import Iterable

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from shapely import MultiPolygon, Polygon

from frontend.scan import Floats

FREE, INK, FAINT, FAKE, OPENED, SKETCH = "#dce9f5", "#1b1b1b", "#b5b5b5", "#d98c00", "#009e73", "#0b62a8"
LANDMARK, INFERRED = "#c23b80", "#8a6fb3"


def sheet(title: str) -> tuple[Figure, Axes]:
    """An empty sheet with axes in metres, and a title."""
    figure = Figure(figsize=(9, 7))
    axes = figure.subplots()
    axes.set(title=title, aspect="equal", xlabel="x (m)", ylabel="y (m)")
    return figure, axes


def framed(figure: Figure, axes: Axes, corners: Floats) -> Figure:
    """The figure with its axes about the corners (k, 2) of what it shows, and its legend."""
    if len(corners):
        low, high = corners.min(axis=0), corners.max(axis=0)
        axes.set(xlim=(low[0] - 0.3, high[0] + 0.3), ylim=(low[1] - 0.3, high[1] + 0.3))
    legend([axes])
    return figure


def legend(panels: list[Axes]) -> None:
    """One legend for all panels, beside the last one, where it hides nothing."""
    named = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if named:
        panels[-1].legend(named.values(), named.keys(), loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8)


def lines(
    axes: Axes, pieces: Floats | list[Floats], ink: str, *, label: str = "", style: str = "solid", width: float = 1.2
) -> None:
    """Draw pieces (e, k, 2), if there are any; a label puts them into the legend."""
    if len(pieces):
        drawn = LineCollection(list(pieces), colors=ink, linestyles=style, linewidths=width, label=label or None)
        axes.add_collection(drawn)


def patch(shape: Polygon | MultiPolygon, **looks: object) -> PathPatch:
    """A polygon with its holes left open."""
    if shape.is_empty:
        return PathPatch(Outline(np.zeros((1, 2))), **looks)
    rings: Iterable[shapely.LinearRing] = [ring for part in _parts(shape) for ring in (part.exterior, *part.interiors)]
    return PathPatch(Outline.make_compound_path(*(Outline(np.asarray(r.coords), closed=True) for r in rings)), **looks)


def _parts(shape: Polygon | MultiPolygon) -> list[Polygon]:
    """Polygons with holes against the sense of their shells, as filling demands."""
    return [part for part in shapely.get_parts(shapely.orient_polygons(shape)) if isinstance(part, Polygon)]


def draw_drive(axes: Axes, poses: Floats) -> None:
    """Draw where the robot stood, poses (n, 3); its first pose larger."""
    axes.plot(poses[:, 0], poses[:, 1], ".-", color=SKETCH, linewidth=0.6, markersize=2, label="drive")
    axes.plot(*poses[0, :2], "o", color=SKETCH, markersize=5)
