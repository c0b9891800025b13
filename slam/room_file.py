"""The room map as GeoJSON: metres in the frame of the first pose, every feature with its kind and provenance."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, MultiPolygon, Point, Polygon
from shapely.errors import ShapelyError
from shapely.geometry import mapping, shape
from shapely.geometry.base import BaseGeometry

from backend.room_map import Door, Floats, MapEdge, MapEdgeKind, Obstacle, RoomMap

DECIMALS = 6  # micrometres: finer than any sensor, so that a map read back is the map that was written
EDGE_KINDS = {MapEdgeKind.REAL: "wall edge", MapEdgeKind.FRONTIER: "frontier"}
Properties = dict[str, Any]


class RoomFileError(Exception):
    """A map file that cannot be read; the message names the file and what is wrong."""


def room_text(room: RoomMap, landmarks: Floats) -> str:
    """The map and its landmarks (l, 2) as a GeoJSON FeatureCollection."""
    frame = "metres, x and y in the frame of the first pose"
    return json.dumps({"type": "FeatureCollection", "frame": frame, "features": [*_features(room, landmarks)]}) + "\n"


def read_room(path: Path) -> RoomMap:
    """The map that `room_text` wrote; the merge's decisions are not kept in the file."""
    features = read_features(path)
    try:
        return RoomMap(
            free=_area(_of_kind(features, "free")),
            safety=_area(_of_kind(features, "safety")),
            edges=tuple(_edge(*feature) for feature in _of_kind(features, *EDGE_KINDS.values())),
            doors=tuple(_door(*feature) for feature in _of_kind(features, "door")),
            obstacles=tuple(_obstacle(*feature) for feature in _of_kind(features, "obstacle")),
            leaks=points_of_kind(features, "leak"),
            leak_reasons=tuple(says["reason"] for _, says in _of_kind(features, "leak")),
        )
    except KeyError as missing:
        raise RoomFileError(
            f"{path}: a feature lacks the property {missing}, which merge writes today; run merge again to read it"
        ) from missing


def read_features(path: Path) -> list[tuple[BaseGeometry, Properties]]:
    """Geometry and properties of every feature of a GeoJSON file."""
    try:
        content = json.loads(path.read_text(encoding="utf-8-sig"))
        return [(shape(feature["geometry"]), feature.get("properties") or {}) for feature in content["features"]]
    except IsADirectoryError as reason:
        raise RoomFileError(
            f"{path} is a folder: name the GeoJSON file in it, which merge calls map.geojson"
        ) from reason
    except OSError as reason:
        raise RoomFileError(f"{path} cannot be read: {reason.strerror or reason}") from reason
    except (json.JSONDecodeError, UnicodeDecodeError) as damage:
        raise RoomFileError(f"{path} is not JSON: {damage}") from damage
    except (KeyError, TypeError, AttributeError, ValueError, ShapelyError) as damage:
        raise RoomFileError(f"{path} is not a GeoJSON FeatureCollection: {damage!r}") from damage


def free_space(path: Path, layer: str) -> tuple[MultiPolygon, str]:
    """Where a robot may be, from any GeoJSON with kinds, and the kind it was taken from.

    Files of merge hold the layers "safety" and "free"; floor plans only free space, or a boundary with obstacles in it.
    """
    features = read_features(path)
    kinds = {str(properties.get("kind")) for _, properties in features}
    taken = next((kind for kind in (layer, "free", "boundary") if kind in kinds), None)
    if taken is None:
        raise RoomFileError(
            f"{path}: no feature of kind safety, free or boundary, only {', '.join(sorted(kinds)) or 'none at all'}"
        )
    outline = _area(_of_kind(features, taken))
    if taken == "boundary":
        outline = _polygons(outline.difference(_area(_of_kind(features, "obstacle", "wall"))))
    if outline.is_empty:
        raise RoomFileError(f"{path}: its {taken} leaves no area free")
    return outline, taken


def points_of_kind(features: Iterable[tuple[BaseGeometry, Properties]], kind: str) -> Floats:
    """(n, 2) the points among the features that are of that kind."""
    return shapely.get_coordinates([geometry for geometry, _ in _of_kind(features, kind)])


def _features(room: RoomMap, landmarks: Floats) -> Iterable[dict[str, Any]]:
    views = sorted({int(view) for edge in room.edges for view in edge.views})
    yield _feature(room.free, {"kind": "free", "support": len(views), "views": views})
    yield _feature(room.safety, {"kind": "safety", "support": len(views), "views": views})
    for edge in room.edges:
        provenance = {"support": edge.support, "contradictions": edge.contradictions, "spread": _rounded(edge.spread)}
        line = LineString([edge.start, edge.end])
        yield _feature(line, {"kind": EDGE_KINDS[edge.kind], **provenance, "views": edge.views.tolist()})
    for door in room.doors:
        says = {"name": door.name, "confidence": _rounded(door.confidence), "views": door.views.tolist()}
        yield _feature(LineString(door.jambs), {"kind": "door", "support": door.views.size, **says})
    for body in room.obstacles:
        says = {"inferred": body.inferred, "support": body.support, "views": body.views.tolist()}
        yield _feature(body.outline, {"kind": "obstacle", **says})
    for number, landmark in enumerate(landmarks):
        yield _feature(Point(landmark), {"kind": "landmark", "number": number})
    for leak, reason in zip(room.leaks, room.leak_reasons, strict=True):
        yield _feature(Point(leak), {"kind": "leak", "reason": reason})


def _feature(geometry: BaseGeometry, properties: Properties) -> dict[str, Any]:
    placed = shapely.transform(geometry, lambda corners: np.round(corners, DECIMALS))
    return {"type": "Feature", "properties": properties, "geometry": mapping(placed)}


def _rounded(value: float) -> float | None:
    """JSON knows no infinity: an unbounded spread is null."""
    return round(float(value), DECIMALS) if np.isfinite(value) else None


def _of_kind(features: Iterable[tuple[BaseGeometry, Properties]], *kinds: str) -> list[tuple[BaseGeometry, Properties]]:
    return [feature for feature in features if feature[1].get("kind") in kinds]


def _area(features: list[tuple[BaseGeometry, Properties]]) -> MultiPolygon:
    return _polygons(shapely.union_all([shapely.make_valid(geometry) for geometry, _ in features]))


def _polygons(geometry: BaseGeometry) -> MultiPolygon:
    return MultiPolygon([part for part in shapely.get_parts(geometry) if isinstance(part, Polygon)])


def _edge(geometry: BaseGeometry, says: Properties) -> MapEdge:
    start, end = shapely.get_coordinates(geometry).tolist()
    kind = next(kind for kind, name in EDGE_KINDS.items() if name == says["kind"])
    spread = float("inf") if says["spread"] is None else float(says["spread"])
    return MapEdge(tuple(start), tuple(end), kind, says["support"], says["contradictions"], spread, _views(says))


def _door(geometry: BaseGeometry, says: Properties) -> Door:
    return Door(says["name"], shapely.get_coordinates(geometry), says["confidence"], _views(says))


def _obstacle(geometry: BaseGeometry, says: Properties) -> Obstacle:
    if not isinstance(geometry, Polygon):
        raise RoomFileError(f"an obstacle is a {geometry.geom_type}, but should be a Polygon")
    return Obstacle(geometry, says["inferred"], says["support"], _views(says))


def _views(says: Properties) -> NDArray[np.int64]:
    return np.array(says["views"], dtype=np.int64)
