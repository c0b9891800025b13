"""Worlds to plan in, read from GeoJSON of every form."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shapely import LineString, Point, Polygon, box
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from slam.room_file import RoomFileError
from slam.simulation.world import read_plan
from slam.world_file import read_world

ROOM = box(0, 0, 10, 6)


def written(folder: Path, *features: tuple[BaseGeometry, dict[str, Any]]) -> Path:
    place = folder / "world.geojson"
    listed = [{"type": "Feature", "geometry": mapping(shape), "properties": says} for shape, says in features]
    place.write_text(json.dumps({"type": "FeatureCollection", "features": listed}), encoding="utf-8")
    return place


def test_a_map_gives_the_layer_that_is_asked_for_and_its_free_space_where_there_is_none(tmp_path: Path) -> None:
    place = written(tmp_path, (ROOM, {"kind": "free"}), (ROOM.buffer(-0.1), {"kind": "safety"}))
    assert read_world(place, "safety").taken == "safety"
    assert read_world(place, "free").world.free.area == pytest.approx(60)
    bare = written(tmp_path, (ROOM, {"kind": "free"}))
    assert read_world(bare, "safety").taken == "free"


def test_obstacles_and_walls_are_taken_out_of_a_boundary(tmp_path: Path) -> None:
    needle = LineString([(8, 0), (8, 6)])
    place = written(
        tmp_path, (ROOM, {"kind": "boundary"}), (box(2, 2, 4, 4), {"kind": "obstacle"}), (needle, {"kind": "wall"})
    )
    free = read_world(place, "safety").world.free
    assert free.area == pytest.approx(56, abs=1e-3)
    assert len(free.geoms) == 2, "a wall without width parts the room"


def test_rectangles_enclose_the_free_space(tmp_path: Path) -> None:
    walls = [box(0, 0, 10, 1), box(9, 0, 10, 6), box(0, 5, 10, 6), box(0, 0, 1, 6)]
    read = read_world(written(tmp_path, *((wall, {"kind": "rectangle"}) for wall in walls)), "safety")
    assert read.taken == "rectangle"
    assert read.world.free.area == pytest.approx(8 * 4)


def test_rectangles_that_enclose_nothing_and_unknown_kinds_are_told_by_name(tmp_path: Path) -> None:
    with pytest.raises(RoomFileError, match="its rectangle encloses no area free"):
        read_world(written(tmp_path, (box(0, 0, 10, 1), {"kind": "rectangle"})), "safety")
    with pytest.raises(RoomFileError, match="only door, table"):
        read_world(written(tmp_path, (ROOM, {"kind": "table"}), (ROOM, {"kind": "door"})), "safety")
    with pytest.raises(RoomFileError, match="only none at all"):
        read_world(written(tmp_path), "safety")


def test_a_floor_plan_is_free_inside_its_walls_but_for_obstacles_and_shut_doors(tmp_path: Path) -> None:
    shell = ROOM.buffer(0.2, join_style="mitre").difference(ROOM)
    parts = [box(4.9, 0, 5.1, 2), box(4.9, 3, 5.1, 6)]
    walls = [(shape, {"kind": "wall"}) for shape in (shell, *parts)]
    inside = [(box(7, 1, 8, 2), {"kind": "obstacle"}), (box(0, 0, 10, 6), {"kind": "room", "name": "hall"})]
    jambs = LineString([(5, 2), (5, 3)])
    opened = read_world(written(tmp_path, *walls, *inside, (jambs, {"kind": "door", "open": True})), "safety")
    assert opened.taken == "wall"
    assert opened.world.free.area == pytest.approx(60 - 0.2 * 5 - 1)
    assert len(opened.world.free.geoms) == 1
    shut = read_world(written(tmp_path, *walls, *inside, (jambs, {"kind": "door", "open": False})), "safety").world
    assert len(shut.free.geoms) == 2


@pytest.mark.parametrize(
    "plan", sorted((Path(__file__).parents[2] / "datasets" / "plans").iterdir()), ids=lambda p: p.stem
)
def test_every_plan_that_is_shipped_is_a_world_in_which_its_own_drive_is_free(plan: Path) -> None:
    drive = read_plan(plan).drive
    assert drive is not None
    assert read_world(plan, "safety").world.free.covers(LineString(drive.waypoints))


def test_every_wall_keeps_off_by_its_own_spread(tmp_path: Path) -> None:
    sure, vague = LineString([(0, 0), (10, 0)]), LineString([(10, 6), (0, 6)])
    place = written(
        tmp_path,
        (ROOM, {"kind": "free"}),
        (sure, {"kind": "wall edge", "spread": 0.02}),
        (vague, {"kind": "wall edge", "spread": 0.1}),
    )
    free = read_world(place, "free", sigmas=3).world.free
    left, right = (free.intersection(LineString([(5, 0), (5, 6)])).bounds[k] for k in (1, 3))
    kept = np.array([left, 6 - right]) / [0.06, 0.3]
    assert ((kept >= 1) & (kept < 1.02)).all(), "three sigmas each, and what chords around corners stand off"
    assert free.covers(Point(0.01, 3)), "a wall of unknown spread keeps nothing off"


def test_a_map_without_spreads_keeps_nothing_off(tmp_path: Path) -> None:
    place = written(tmp_path, (Polygon(ROOM), {"kind": "free"}))
    with pytest.raises(RoomFileError, match="no wall edge with a spread"):
        read_world(place, "free", sigmas=2)
