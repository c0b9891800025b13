"""The truth of a simulated recording: its floor plan, in the frame of the first pose."""

import json

import numpy as np
from shapely import LineString
from shapely.affinity import affine_transform
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from frontend.rigid_motion import inverse
from frontend.scan import Floats
from slam.simulation.world import World


def truth_geojson(world: World, first: Floats) -> bytes:
    """The plan in the frame of the first true pose (3,): free space, walls, obstacles and doors."""
    parts: list[tuple[BaseGeometry, dict[str, object]]] = [(world.free, {"kind": "free"})]
    for body in world.solids:
        kind = "obstacle" if body.kind == "obstacle" else "wall"
        parts.append((body.outline, {"kind": kind, "material": body.material}))
    parts += [
        (LineString(door.jambs), {"kind": "door", "name": door.name, "open": door.is_open}) for door in world.doors
    ]
    features = [
        {"type": "Feature", "properties": properties, "geometry": _placed(geometry, inverse(first))}
        for geometry, properties in parts
    ]
    return json.dumps({"type": "FeatureCollection", "features": features}).encode() + b"\n"


def _placed(geometry: BaseGeometry, motion: Floats) -> dict[str, object]:
    cosine, sine = float(np.cos(motion[2])), float(np.sin(motion[2]))
    moved = affine_transform(geometry, [cosine, -sine, sine, cosine, float(motion[0]), float(motion[1])])
    rounded: dict[str, object] = json.loads(
        json.dumps(mapping(moved)), parse_float=lambda digits: round(float(digits), 4)
    )
    return rounded
