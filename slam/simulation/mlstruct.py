"""Real floors of the MLSTRUCT-FP set as plans: its wall rectangles stand inside the slab they were drawn on."""

import json
from pathlib import Path
from typing import Any

import shapely
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from slam.simulation.floors import Plan, feature, plan_of, polygons_of
from slam.simulation.world import PlanError

STEP = 0.25  # metres: the drive of a converted floor is one such step; give poses for more


def convert_mlstruct(path: Path, floor: int) -> Plan:
    """The plan of one floor of an `fp.json`, in its own metres; raises PlanError where there is no such floor."""
    try:
        drawing = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise PlanError(f"{path} cannot be read as JSON: {error}") from error
    try:
        walls, slabs = (_of_floor(drawing, kind, floor, path) for kind in ("rect", "slab"))
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        shape = 'shapes "rect" and "slab" by name, each with floorID and as many x as y'
        said = f"{type(error).__name__}: {error}"
        raise PlanError(f"{path} is no fp.json of MLSTRUCT-FP, which holds {shape} ({said})") from error
    # Windows and doors are both gaps: beyond the slab there is nothing to see, so its rim closes the windows.
    slab = shapely.union_all([*slabs, *walls])
    outer = max((Polygon(part.exterior) for part in polygons_of(slab)), key=lambda part: part.area)
    start = _roomiest(outer.difference(shapely.union_all(walls)))
    drive = LineString([(start.x, start.y), (start.x + STEP, start.y)])
    return plan_of(
        f"mlstruct {floor}",
        f"Floor {floor} of MLSTRUCT-FP: {len(walls)} walls; the drive is one step in its roomiest place",
        [
            feature(outer, "boundary", material="rough"),
            *(feature(wall, "wall", material="rough") for wall in walls),
            feature(drive, "drive"),
        ],
    )


def _of_floor(drawing: dict[str, Any], kind: str, floor: int, path: Path) -> list[Polygon]:
    shapes = drawing.get(kind, {}).values()
    outlines = [Polygon(zip(s["x"], s["y"], strict=True)).buffer(0) for s in shapes if s["floorID"] == floor]
    if not outlines:
        known = sorted({s["floorID"] for s in shapes})
        found = f"known floors are {', '.join(map(str, known))}" if known else f"and no {kind} at all"
        raise PlanError(f"{path} has no {kind} on floor {floor}, {found}")
    return [part for outline in outlines for part in polygons_of(outline)]


def _roomiest(free: BaseGeometry) -> Point:
    """The middle of the largest circle that fits into the free space."""
    largest = max(polygons_of(free), key=lambda part: part.area)
    return Point(shapely.maximum_inscribed_circle(largest, 0.05).coords[0])
