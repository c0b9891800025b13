"""Floors: rooms drawn as polygons, with the walls between them, doors cut through, and things standing in them."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Point, Polygon
from shapely.affinity import rotate, translate
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from frontend.scan import Floats
from slam.whole_output import write_whole

Plan = dict[str, Any]
Doors = Mapping[str, LineString]


def feature(geometry: BaseGeometry, kind: str, **properties: object) -> Plan:
    """One feature of a plan; coordinates are kept to the tenth of a millimetre."""

    def rounded(part: Any) -> Any:
        return [rounded(item) for item in part] if isinstance(part, tuple) else round(part, 4)

    shape = mapping(geometry)
    placed = {"type": shape["type"], "coordinates": rounded(shape["coordinates"])}
    return {"type": "Feature", "properties": {"kind": kind, **properties}, "geometry": placed}


def plan_of(name: str, description: str, features: Sequence[Plan]) -> Plan:
    """A plan file's content."""
    return {"type": "FeatureCollection", "name": name, "description": description, "features": list(features)}


def write_plan(plan: Plan, path: Path) -> None:
    """Write a plan file, one feature a line, whole or not at all. Raises OutputError."""
    head = {"type": "FeatureCollection"} | {key: value for key, value in plan.items() if key != "features"}
    features = ",\n".join(json.dumps(part) for part in plan["features"])
    write_whole(path, f'{json.dumps(head)[:-1]}, "features": [\n{features}\n]}}\n')


def walls_around(
    rooms: Mapping[str, BaseGeometry], doors: Doors, thickness: float, smooth: Sequence[str] = ()
) -> list[Plan]:
    """Walls, doors and rooms of a floor whose rooms stand `thickness` apart; those of `smooth` rooms are mirrors."""
    inside = shapely.union_all(list(rooms.values()))
    gaps = [line.buffer(1.5 * thickness, cap_style="flat") for line in doors.values()]
    shell = inside.buffer(thickness, join_style="mitre").difference(shapely.union_all([inside, *gaps]))
    # A wall is plastered on the side of its own room: each side is half of it.
    plastered = shapely.union_all([rooms[name].buffer(thickness / 2, join_style="mitre") for name in smooth])
    rough, mirror = shell.difference(plastered), shell.intersection(plastered)
    return [
        *(feature(part, "wall", material="rough") for part in polygons_of(rough)),
        *(feature(part, "wall", material="smooth") for part in polygons_of(mirror)),
        *(feature(line, "door", name=name, open=True) for name, line in doors.items()),
        *(feature(room, "room", name=name) for name, room in rooms.items()),
    ]


def polygons_of(geometry: BaseGeometry) -> list[Polygon]:
    """The polygons of a geometry, slivers under a square centimetre left out."""
    return [part for part in shapely.get_parts(geometry) if isinstance(part, Polygon) and part.area > 1e-4]


def drive_along(waypoints: Sequence[Sequence[float]] | Floats, **properties: object) -> Plan:
    """The drive of a plan: `step`, `headings` in degrees and `wheels` as the world reads them."""
    return feature(LineString(np.asarray(waypoints, float)), "drive", **properties)


def ell(corner: tuple[float, float], turn: float, leg: float, thick: float) -> Polygon:
    """An L of two legs, its outer corner at `corner`, turned by `turn` degrees."""
    shape = Polygon([(0, 0), (leg, 0), (leg, thick), (thick, thick), (thick, leg), (0, leg)])
    return translate(rotate(shape, turn, origin=(0, 0)), *corner)


def pillar(centre: tuple[float, float], radius: float, material: str = "rough") -> Plan:
    """A round obstacle."""
    disc = Point(centre).buffer(radius, quad_segs=12)
    return feature(disc, "obstacle", material=material, radius=round(radius, 4), name="round obstacle")
