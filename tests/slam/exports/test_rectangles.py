"""Thin rectangles as a file: every one a rectangle of the paper's width, chains apart, and planners read them."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, Polygon, box
from shapely.geometry import shape

from backend.thin_rectangles import thin_rectangles
from slam.exports.rectangles import rectangles_text
from slam.world_file import read_world

PILLAR = box(1.5, 1.0, 2.0, 1.4)
FREE = MultiPolygon([Polygon(box(0, 0, 4, 3).exterior, [PILLAR.exterior]), box(6, 0, 8, 2)])


def test_every_rectangle_is_as_thin_as_the_unit_and_chains_are_as_many_as_rings() -> None:
    told = json.loads(rectangles_text(thin_rectangles(FREE)))
    for feature in told["features"]:
        drawn = shape(feature["geometry"])
        sides = np.linalg.norm(np.diff(shapely.get_coordinates(drawn), axis=0), axis=1)
        assert min(sides) == pytest.approx(told["unit"], rel=1e-6)
        assert drawn.area == pytest.approx(min(sides) * max(sides), rel=1e-6)
    assert {feature["properties"]["chain"] for feature in told["features"]} == {0, 1, 2}


def test_a_planner_that_reads_them_back_is_shut_into_the_same_rooms(tmp_path: Path) -> None:
    path = tmp_path / "room.rectangles.geojson"
    path.write_text(rectangles_text(thin_rectangles(FREE)))
    free, unit = read_world(path, "safety").world.free, json.loads(path.read_text())["unit"]
    for room in shapely.get_parts(FREE):
        (read,) = (part for part in free.geoms if part.intersects(room.buffer(-unit)))
        assert room.buffer(unit).covers(read)
        assert read.covers(room.buffer(-unit))
