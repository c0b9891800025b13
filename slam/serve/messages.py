"""What the page is told: one line of JSON and the bytes of its arrays, in one binary message.

Layout: the head's length (uint32), the head as JSON, then the arrays one after another, each from a multiple of four.
The head names every array with its type, shape and place. Everything is little-endian.
"""

import json
from collections.abc import Iterable
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from backend.room_map import MapEdgeKind, RoomMap
from frontend.contour import ContourKind, EdgeKind
from frontend.scan import Booleans, Floats
from slam.perception import Percept

Arrays = dict[str, NDArray[Any]]
KINDS = {"f": "<f4", "i": "<i4", "u": "<i4", "b": "|u1"}  # what an array of each kind travels as


def pack(kind: str, says: dict[str, Any] | None = None, arrays: Arrays | None = None) -> bytes:
    """One message: its kind, plain values, and arrays by name (floats in 4 bytes, whole numbers in 4, bytes in 1)."""
    placed, body = {}, b""
    for name, array in (arrays or {}).items():
        travels = "|u1" if array.dtype == np.uint8 else KINDS[array.dtype.kind]
        placed[name] = {"type": travels[1:], "shape": list(array.shape), "at": len(body)}
        content = np.ascontiguousarray(array, dtype=travels).tobytes()
        body += content + bytes(-len(content) % 4)
    head = json.dumps({"kind": kind, **(says or {}), "arrays": placed}, allow_nan=False).encode()
    head += b" " * (-len(head) % 4)
    return len(head).to_bytes(4, "little") + head + body


def unpack(message: bytes) -> tuple[dict[str, Any], Arrays]:
    """The head and the arrays of a message."""
    start = 4 + int.from_bytes(message[:4], "little")
    head = json.loads(message[4:start])
    arrays = {}
    for name, placed in head.pop("arrays").items():
        count = int(np.prod(placed["shape"]))
        flat = np.frombuffer(message, np.dtype(placed["type"]), count, start + placed["at"])
        arrays[name] = flat.reshape(placed["shape"])
    return head, arrays


def kind_of(message: bytes) -> str:
    """What a message is about."""
    return str(unpack(message)[0]["kind"])


def scan_message(index: int, percept: Percept, pose: Floats) -> bytes:
    """One scan in the robot's frame, and its pose (3,) as believed when it was taken.

    raw: (n, 2) readings; lost: (n,) whether nothing came back. ring: (v, 2) the redrawn boundary; edges: (v,) EdgeKind.
    fillers: (f, 2). knots: (k, 2) landmark knots; doubts: (k, 3) their covariances xx, xy, yy.
    """
    contour, sketch = percept.contour, percept.sketch
    vertices = contour.vertices
    filler = contour.kinds == ContourKind.FILLER
    return pack(
        "scan",
        {"index": index, "time": percept.scan.time},
        {
            "pose": pose,
            "raw": percept.raw_ends,
            "lost": (~np.isfinite(percept.fused.raw_ranges)).astype(np.uint8),
            "ring": contour.points[vertices],
            "edges": contour.edge_kinds[vertices],
            "fillers": contour.points[filler & (contour.edge_kinds != EdgeKind.SIDE)],
            "knots": sketch.positions[sketch.landmark],
            "doubts": upper(sketch.covariances[sketch.landmark]),
        },
    )


def poses_message(poses: Floats, covariances: Floats | None = None, mapped: Booleans | None = None) -> bytes:
    """Where all scans so far were taken (n, 3), how surely, and which of them stand in the map.

    doubts: (n, 3) xx, xy, yy in each robot's own axes, where known. mapped: (n,), all of them unless told.
    """
    doubts = {} if covariances is None else {"doubts": upper(covariances[:, :2, :2])}
    told = np.ones(len(poses), np.uint8) if mapped is None else mapped.astype(np.uint8)
    return pack("poses", {}, {"poses": poses, "mapped": told, **doubts})


def room_message(room: RoomMap, mapped: Booleans, landmarks: Floats, *, final: bool) -> bytes:
    """The map as merged so far. mapped: (n,) which scans so far are its views; the page counts views like scans."""
    scans = np.flatnonzero(mapped)
    edges = room.edges
    spreads = np.array([edge.spread if np.isfinite(edge.spread) else -1.0 for edge in edges])
    says = {
        "views": len(mapped),
        "final": final,
        "area": room.free.area,
        "doors": [
            {"name": door.name, "confidence": door.confidence, "views": scans[door.views].tolist()}
            for door in room.doors
        ],
        "obstacles": [
            {"inferred": body.inferred, "support": body.support, "views": scans[body.views].tolist()}
            for body in room.obstacles
        ],
    }
    arrays = {
        **rings_of("free", [room.free]),
        **rings_of("safety", [room.safety]),
        **rings_of("bodies", [body.outline for body in room.obstacles]),
        "lines": np.array([[*edge.start, *edge.end] for edge in edges]).reshape(-1, 4),
        "frontier": np.array([edge.kind is MapEdgeKind.FRONTIER for edge in edges], np.uint8),
        "support": np.array([edge.support for edge in edges], np.int64),
        "contradictions": np.array([edge.contradictions for edge in edges], np.int64),
        "spread": spreads,
        "seenBy": scans[np.concatenate([np.empty(0, np.int64), *(edge.views for edge in edges)])],
        "seenCount": np.array([edge.views.size for edge in edges], np.int64),
        "jambs": np.array([door.jambs for door in room.doors]).reshape(-1, 4),
        "landmarks": landmarks.reshape(-1, 2),
        "leaks": room.leaks.reshape(-1, 2),
    }
    return pack("room", says, arrays)


def rings_of(name: str, shapes: Iterable[BaseGeometry]) -> Arrays:
    """All rings of the shapes: corners (c, 2), how many belong to each ring, and which shape each ring is of."""
    corners, counts, owners = [np.empty((0, 2))], [], []
    for owner, shape in enumerate(shapes):
        for ring in shapely.get_rings(shapely.get_parts(shape)):
            points = shapely.get_coordinates(ring)[:-1]
            corners.append(points)
            counts.append(len(points))
            owners.append(owner)
    return {
        name: np.concatenate(corners),
        f"{name}Counts": np.array(counts, np.int64),
        f"{name}Owners": np.array(owners, np.int64),
    }


def upper(covariances: Floats) -> Floats:
    """xx, xy and yy (k, 3) of covariances (k, 2, 2)."""
    return np.asarray(covariances.reshape(-1, 4)[:, [0, 1, 3]])
