"""Planning through the command line: worlds of every form, both planners side by side, clearance by the map's σ."""

import json
from pathlib import Path
from typing import Any

import pytest
import shapely
from shapely import LineString, MultiPolygon, Polygon, box
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from backend.thin_rectangles import thin_rectangles
from slam.exports.rectangles import rectangles_text
from tests.stories.command_line import Told, run

TWO_ROOMS = Polygon(
    shapely.get_coordinates(box(0, 0, 10, 6) - shapely.union_all([box(4.5, 0, 5.5, 2.4), box(4.5, 3.6, 5.5, 6)]))
)
ROBOT = ("--robot", "rectangle:1.2x0.6")


def write(place: Path, *features: tuple[BaseGeometry, dict[str, Any]]) -> Path:
    """A GeoJSON file with these geometries and properties."""
    listed = [{"type": "Feature", "geometry": mapping(shape), "properties": says} for shape, says in features]
    place.write_text(json.dumps({"type": "FeatureCollection", "features": listed}), encoding="utf-8")
    return place


@pytest.fixture
def plan_file(tmp_path: Path) -> Path:
    """Two rooms with a door of 1.2 m."""
    return write(tmp_path / "rooms.geojson", (TWO_ROOMS, {"kind": "free"}))


def plan(room: Path, start: str, goal: str, *more: object) -> Told:
    return run("plan", room, "--from", start, "--to", goal, *more)


def test_both_planners_are_compared_with_a_figure_and_both_paths(plan_file: Path, tmp_path: Path) -> None:
    figure, paths = tmp_path / "plans.png", tmp_path / "paths.geojson"
    asked = "1,1,0", "9,5,1.57", *ROBOT, "--planner", "both", "--figure", figure, "--out", paths
    told = plan(plan_file, *asked, "--json")
    assert told.code == 0
    values = json.loads(told.out)
    for name in ("cones", "configuration-space"):
        assert values[name]["answer"] == "path"
        assert values[name]["turning"] >= 1.57 - 1e-9
        assert values[name]["seconds"] > 0
    assert values["cones"]["clearance"] > values["configuration-space"]["clearance"]
    assert "farther than configuration-space" in values["comparison"]
    assert figure.read_bytes().startswith(b"\x89PNG")
    features = json.loads(paths.read_text(encoding="utf-8"))["features"]
    assert [feature["properties"]["planner"] for feature in features] == ["cones", "configuration-space"]
    table = plan(plan_file, *asked).out
    assert "turning" in table
    assert "more clearance" in table


def test_a_proof_that_there_is_no_path_settles_it_for_both(plan_file: Path) -> None:
    told = plan(plan_file, "1,1", "9,5", "--robot", "rectangle:2x1.3", "--planner", "both")
    assert told.code == 3
    assert "the widest way is 1.2 m wide; needed are 1.3 m" in told.out
    assert "so no planner finds a path" in told.out


@pytest.mark.parametrize("planner", ["cones", "configuration-space"])
@pytest.mark.parametrize("layer", ["safety", "best"])
def test_a_map_offers_its_safety_layer_and_its_best_estimate(tmp_path: Path, planner: str, layer: str) -> None:
    inset = TWO_ROOMS.buffer(-0.1, join_style="mitre")
    room = write(tmp_path / "map.geojson", (TWO_ROOMS, {"kind": "free"}), (inset, {"kind": "safety"}))
    told = plan(room, "1,1", "9,5", "--robot", "disc:0.55", "--planner", planner, "--layer", layer, "--json")
    assert (told.code, json.loads(told.out)["answer"] == "path") == ((0, True) if layer == "best" else (3, False))


@pytest.mark.parametrize("planner", ["cones", "configuration-space"])
def test_thin_rectangles_are_walls(tmp_path: Path, planner: str) -> None:
    room = tmp_path / "rectangles.geojson"
    room.write_text(rectangles_text(thin_rectangles(MultiPolygon([TWO_ROOMS]))))
    told = plan(room, "1,1,0", "9,5", *ROBOT, "--planner", planner, "--json")
    assert told.code == 0
    assert json.loads(told.out)["layer"] == "rectangle"


@pytest.mark.parametrize("planner", ["cones", "configuration-space"])
def test_obstacles_stand_in_a_boundary(tmp_path: Path, planner: str) -> None:
    walls = [(box(4.5, 0, 5.5, 2.4), {"kind": "obstacle"}), (box(4.5, 3.6, 5.5, 6), {"kind": "obstacle"})]
    needle = LineString([(7, 0), (7, 6)])
    boundary = box(0, 0, 10, 6), {"kind": "boundary"}
    open_room = write(tmp_path / "open.geojson", boundary, *walls)
    assert plan(open_room, "1,1", "9,5", *ROBOT, "--planner", planner).code == 0
    shut = write(tmp_path / "shut.geojson", boundary, *walls, (needle, {"kind": "obstacle"}))
    assert plan(shut, "1,1", "9,5", *ROBOT, "--planner", planner).code == 3


@pytest.mark.parametrize("planner", ["cones", "configuration-space", "both"])
@pytest.mark.parametrize(
    ("start", "goal", "says"),
    [
        ("5,1", "9,5", "start (5, 1) lies 0.5 m outside of free space, in an obstacle"),
        ("1,1", "12,3", "goal (12, 3) lies 2 m outside of free space, where no wall encloses it"),
        ("0.1,1,0", "9,5", "start (0.1, 1) at 0° overlaps an obstacle: the robot reaches 0.5 m into it"),
    ],
)
def test_who_cannot_stand_is_told_where_and_by_how_much(
    tmp_path: Path, planner: str, start: str, goal: str, says: str
) -> None:
    block = box(4.5, 0.5, 5.5, 2.4), {"kind": "obstacle"}
    room = write(tmp_path / "room.geojson", (box(0, 0, 10, 6), {"kind": "boundary"}), block)
    told = plan(room, start, goal, *ROBOT, "--planner", planner)
    assert told.code == 1
    assert says in told.err


def test_a_wall_seen_once_keeps_the_robot_farther_away_than_one_seen_often(tmp_path: Path) -> None:
    corridor = Polygon([(0, 0), (8, 0), (8, 2), (0, 2)])
    once, often = 0.1, 0.1 / 20**0.5
    edges = [
        (LineString([(0, 0), (8, 0)]), {"kind": "wall edge", "support": 1, "spread": once}),
        (LineString([(8, 2), (0, 2)]), {"kind": "wall edge", "support": 20, "spread": often}),
        (LineString([(0, 2), (0, 0)]), {"kind": "frontier", "support": 0, "spread": None}),
    ]
    block = Polygon([(3.5, 0.9), (4.5, 0.9), (4.5, 1.1), (3.5, 1.1)])
    room = write(tmp_path / "map.geojson", (corridor.difference(block), {"kind": "free"}), *edges)
    asked = "--robot", "disc:0.3", "--planner", "configuration-space", "--json"
    passes = {}
    for sigmas in (0, 3):
        told = plan(room, "0.5,1", "7.5,1", *asked, "--clearance-sigmas", sigmas)
        passes[sigmas] = [y for _, y, _ in json.loads(told.out)["poses"]]
    assert told.code == 0
    assert min(passes[3]) > 0.999, "the way beside the wall seen once is shut"


def test_clearance_in_sigmas_needs_a_map_that_knows_them(plan_file: Path) -> None:
    told = plan(plan_file, "1,1", "9,5", *ROBOT, "--planner", "cones", "--clearance-sigmas", 2)
    assert told.code == 1
    assert "no wall edge with a spread" in told.err


def test_a_figure_under_another_name_than_png_is_refused_before_anything_is_planned(
    plan_file: Path, tmp_path: Path
) -> None:
    figure = tmp_path / "plans.txt"
    told = plan(plan_file, "1,1", "9,5", *ROBOT, "--planner", "cones", "--figure", figure)
    assert (told.code, told.out) == (1, "")
    assert f"{figure} does not end in .png" in told.err
    assert not figure.exists()
