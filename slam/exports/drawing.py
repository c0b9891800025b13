"""The map as drawings in metres: SVG for browsers and illustration programs, DXF for CAD."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import shapely
from shapely import Polygon

from backend.room_map import Floats, MapEdgeKind
from slam.exports.product import ExportError, Product

MARGIN = 0.5  # metres around the map
HAIR = 0.02  # metres: width of a drawn line
LOOKS = {  # layer: SVG colour, dashes in metres, DXF colour index
    "free": ("#dce9f5", "", 4),
    "wall": ("#1b1b1b", "", 7),
    "frontier": ("#d98c00", "0.1 0.1", 30),
    "door": ("#009e73", "", 3),
    "obstacle": ("#1b1b1b", "", 1),
    "inferred obstacle": ("#8a6fb3", "0.06 0.04", 6),
    "landmark": ("#c23b80", "", 210),
    "trajectory": ("#0b62a8", "", 5),
    "path": ("#d55e00", "", 30),
}


@dataclass(frozen=True, eq=False)
class Stroke:
    """One line of the drawing, corners (k, 2), on a layer of LOOKS. says: what is known of it."""

    layer: str
    corners: Floats
    closed: bool
    says: str


def strokes(product: Product) -> Iterator[Stroke]:
    """Every line of the drawing, layer by layer from the ground up."""
    room = product.room
    for ring in _rings(list(room.free.geoms)):
        yield Stroke("free", ring, True, "free space")
    for edge in room.edges:
        layer = "wall" if edge.kind is MapEdgeKind.REAL else "frontier"
        says = f"{layer}, seen by {edge.support} views, contradicted by {edge.contradictions}"
        yield Stroke(layer, np.array([edge.start, edge.end]), False, says)
    for body in room.obstacles:
        layer = "inferred obstacle" if body.inferred else "obstacle"
        for ring in _rings([body.outline]):
            yield Stroke(layer, ring, True, f"{layer}, {body.support} views")
    for door in room.doors:
        yield Stroke(
            "door", door.jambs, False, f"{door.name}, {door.width:.2f} m wide, confidence {door.confidence:.2f}"
        )
    if product.trajectory is not None:
        yield Stroke("trajectory", product.trajectory.positions, False, "the sensor's way")


def write_svg(product: Product, path: Path) -> None:
    """The drawing as a file of its own."""
    path.write_text('<?xml version="1.0" encoding="utf-8"?>\n' + svg_text(product) + "\n", encoding="utf-8")


def svg_text(product: Product, paths: dict[str, Floats] | None = None) -> str:
    """One group for every layer; an edge's provenance is its tool tip. y points up on the page, one unit is a metre.

    paths: planned ways (p, 3) by name, drawn over the map.
    """
    low, high = np.reshape(product.room.free.bounds, (2, 2)) + np.array([[-MARGIN], [MARGIN]])
    box = f"{low[0]:.3f} {-high[1]:.3f} {high[0] - low[0]:.3f} {high[1] - low[1]:.3f}"
    page = ElementTree.Element("svg", {"xmlns": "http://www.w3.org/2000/svg", "viewBox": box, "font-size": "0.2"})
    ElementTree.SubElement(page, "title").text = "room map, metres"
    groups = {layer: ElementTree.SubElement(page, "g", _svg_looks(layer)) for layer in LOOKS}
    # One path with all rings: holes stay open under the even-odd rule.
    ground = " ".join(_svg_line(stroke) for stroke in strokes(product) if stroke.layer == "free")
    ElementTree.SubElement(groups["free"], "path", {"d": ground})
    ways = [Stroke("path", way[:, :2], False, name) for name, way in (paths or {}).items()]
    for stroke in [*strokes(product), *ways]:
        if stroke.layer != "free":
            line = ElementTree.SubElement(groups[stroke.layer], "path", {"d": _svg_line(stroke)})
            ElementTree.SubElement(line, "title").text = stroke.says
    for x, y in product.landmarks:
        ElementTree.SubElement(groups["landmark"], "circle", {"cx": f"{x:.4f}", "cy": f"{-y:.4f}", "r": f"{2 * HAIR}"})
    ElementTree.indent(page)
    return ElementTree.tostring(page, encoding="unicode")


def write_dxf(product: Product, path: Path) -> None:
    """One layer for every kind of line, units set to metres; needs the extra [cad]."""
    try:
        from ezdxf import units  # noqa: PLC0415  # an extra: only who exports to CAD needs it
        from ezdxf.filemanagement import new  # noqa: PLC0415
    except ImportError as reason:
        raise ExportError("DXF needs ezdxf: pip install 'roomsketch[cad]'") from reason
    drawing = new(units=units.M)
    for layer, (_, _, colour) in LOOKS.items():
        drawing.layers.add(layer, color=colour)
    space = drawing.modelspace()
    for stroke in strokes(product):
        space.add_lwpolyline(stroke.corners.tolist(), close=stroke.closed, dxfattribs={"layer": stroke.layer})
    for place in product.landmarks.tolist():
        space.add_point(place, dxfattribs={"layer": "landmark"})
    drawing.saveas(path)


def _rings(shapes: list[Polygon]) -> list[Floats]:
    """The corners of every ring, without the repeated last one."""
    return [shapely.get_coordinates(ring)[:-1] for shape in shapes for ring in [shape.exterior, *shape.interiors]]


def _svg_looks(layer: str) -> dict[str, str]:
    colour, dashes, _ = LOOKS[layer]
    name = {"id": layer.replace(" ", "-")}
    if layer == "free":
        return name | {"fill": colour, "fill-rule": "evenodd", "stroke": "none"}
    looks = name | {"fill": "none", "stroke": colour, "stroke-width": f"{HAIR}", "stroke-linecap": "round"}
    return looks | ({"stroke-dasharray": dashes} if dashes else {})


def _svg_line(stroke: Stroke) -> str:
    corners = " L".join(f"{x:.4f} {-y:.4f}" for x, y in stroke.corners)
    return f"M{corners}{' Z' if stroke.closed else ''}"
