"""The map as a GeoPackage: one layer for each kind of thing, with what is known of it as columns."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Point
from shapely.geometry.base import BaseGeometry

from backend.room_map import MapEdge, MapEdgeKind
from slam.exports.product import ExportError, Product

# A room has no place on earth: an engineering frame in metres says so to whoever opens the file.
FRAME = 'LOCAL_CS["frame of the first pose",LOCAL_DATUM["robot",0],UNIT["metre",1],AXIS["x",EAST],AXIS["y",NORTH]]'


@dataclass(frozen=True, eq=False)
class Layer:
    """Geometries of one type and, name by name, as many values."""

    name: str
    geometry_type: str
    geometries: list[BaseGeometry]
    columns: dict[str, list[Any]]


def write_geopackage(product: Product, path: Path) -> None:
    """Every layer that is not empty; needs the extra [gis]."""
    try:
        from pyogrio.raw import write  # noqa: PLC0415  # an extra: only who exports to a GIS needs it
    except ImportError as reason:
        raise ExportError("GeoPackage needs pyogrio: pip install 'roomsketch[gis]'") from reason
    filled = [layer for layer in layers(product) if layer.geometries]
    for number, layer in enumerate(filled):
        write(
            path,
            np.array([shapely.to_wkb(geometry) for geometry in layer.geometries], object),
            [np.array(values) for values in layer.columns.values()],
            list(layer.columns),
            layer=layer.name,
            driver="GPKG",
            geometry_type=layer.geometry_type,
            crs=FRAME,
            append=number > 0,
        )


def layers(product: Product) -> Iterable[Layer]:
    """The layers of the map, areas first."""
    room = product.room
    yield Layer("free", "MultiPolygon", [room.free], {"area": [room.free.area]})
    yield Layer("safety", "MultiPolygon", [room.safety], {"area": [room.safety.area]})
    yield _edges("walls", [edge for edge in room.edges if edge.kind is MapEdgeKind.REAL])
    yield _edges("frontiers", [edge for edge in room.edges if edge.kind is MapEdgeKind.FRONTIER])
    doors: dict[str, list[Any]] = {
        "name": [door.name for door in room.doors],
        "width": [door.width for door in room.doors],
        "confidence": [float(door.confidence) for door in room.doors],
    }
    yield Layer("doors", "LineString", [LineString(door.jambs) for door in room.doors], doors)
    bodies: dict[str, list[Any]] = {
        "inferred": [int(body.inferred) for body in room.obstacles],
        "support": [int(body.support) for body in room.obstacles],
    }
    yield Layer("obstacles", "Polygon", [body.outline for body in room.obstacles], bodies)
    places = [Point(place) for place in product.landmarks]
    yield Layer("landmarks", "Point", list(places), {"number": list(range(len(places)))})


def _edges(name: str, edges: list[MapEdge]) -> Layer:
    columns: dict[str, list[Any]] = {
        "support": [int(edge.support) for edge in edges],
        "contradictions": [int(edge.contradictions) for edge in edges],
        "spread": [float(edge.spread) if np.isfinite(edge.spread) else np.nan for edge in edges],
        "views": [" ".join(map(str, edge.views.tolist())) for edge in edges],
    }
    return Layer(name, "LineString", [LineString([edge.start, edge.end]) for edge in edges], columns)
