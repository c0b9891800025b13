"""Floor plans that the shipped recordings were made in: every one is drawn here, in feet where the paper has feet."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from shapely import LineString, Point, Polygon, box
from shapely.affinity import rotate, translate
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from frontend.sensors.transducer import FOOT, INCH

Plan = dict[str, Any]


def feature(geometry: BaseGeometry, kind: str, **properties: object) -> Plan:
    """One feature of a plan; coordinates are kept to the tenth of a millimetre."""
    return {"type": "Feature", "properties": {"kind": kind, **properties}, "geometry": _rounded(mapping(geometry))}


def _rounded(geometry: dict[str, Any]) -> dict[str, Any]:
    def walk(part: Any) -> Any:
        return [walk(item) for item in part] if isinstance(part, tuple) else round(part, 4)

    return {"type": geometry["type"], "coordinates": walk(geometry["coordinates"])}


def plan_of(name: str, description: str, features: list[Plan]) -> Plan:
    """A plan file's content."""
    return {"type": "FeatureCollection", "name": name, "description": description, "features": features}


def folding_door(corner: tuple[float, float], turn: float, material: str) -> Plan:
    """An L-shaped obstacle: two leaves of a folding closet door, 2 ft each and 2 in thick, hinged at a right angle."""
    long, thick = 2 * FOOT, 2 * INCH
    shape = Polygon([(0, 0), (long, 0), (long, thick), (thick, thick), (thick, long), (0, long)])
    placed = translate(rotate(shape, turn, origin=(0, 0)), corner[0] * FOOT, corner[1] * FOOT)
    return feature(placed, "obstacle", material=material, name="folding closet door")


def pillar(centre: tuple[float, float], diameter: float, material: str) -> Plan:
    """A round obstacle; centre and diameter in feet."""
    disc = Point(centre[0] * FOOT, centre[1] * FOOT).buffer(diameter / 2 * FOOT, quad_segs=12)
    return feature(disc, "obstacle", material=material, radius=round(diameter / 2 * FOOT, 4), name="round obstacle")


def basement() -> Plan:
    """The paper's room, 19 × 13 ft, with three doors, two L-shapes and a round obstacle (Figs 9, 11, 12)."""
    openings = {
        "left door": ((0.0, 2.9), (0.0, 5.567)),
        "front door": ((4.4, 13.0), (7.067, 13.0)),
        "right door": ((19.0, 5.2), (19.0, 8.2)),
    }
    passage = _feet_box(-8, -0.5, 27, 21)
    room, thick = _feet_box(0, 0, 19, 13), 0.5 * FOOT
    shell = room.buffer(thick, join_style="mitre").difference(room)
    doors = {name: LineString(np.array(jambs) * FOOT) for name, jambs in openings.items()}
    for line in doors.values():
        shell = shell.difference(line.buffer(2 * thick, cap_style="flat"))
    outer = passage.buffer(thick, join_style="mitre").difference(passage)
    walls = [*_parts(shell), *_parts(outer)]
    return plan_of(
        "flynn_basement",
        "Three views of a basement room of 19 x 13 ft with rough walls; each pose is 2 ft from the one before",
        [
            *(feature(wall, "wall", material="rough") for wall in walls),
            *(feature(line, "door", name=name, open=True) for name, line in doors.items()),
            folding_door((1.2, 9.8), -90, "rough"),
            folding_door((16.0, 2.0), 90, "rough"),
            pillar((9.0, 9.0), 1.3, "rough"),
            feature(room, "room", name="basement"),
            feature(
                LineString(np.array([(8, 4), (10, 4), (10, 6)]) * FOOT),
                "drive",
                name="three views",
                headings=[90, 90, 90],
            ),
        ],
    )


def _feet_box(left: float, bottom: float, right: float, top: float) -> Polygon:
    return box(left * FOOT, bottom * FOOT, right * FOOT, top * FOOT)


def _parts(geometry: Any) -> list[Polygon]:
    return list(getattr(geometry, "geoms", [geometry]))


PLANS = {"flynn_basement": basement}


def write_plan(plan: Plan, path: Path) -> None:
    """Write a plan file, one feature a line, to a temporary name first."""
    head = {key: value for key, value in plan.items() if key != "features"}
    features = ",\n".join(json.dumps(part) for part in plan["features"])
    making = path.with_name(f".{path.name}")
    making.write_text(f'{json.dumps(head)[:-1]}, "features": [\n{features}\n]}}\n')
    making.replace(path)
