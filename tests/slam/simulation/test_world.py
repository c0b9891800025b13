import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from shapely import LineString, box

from slam.simulation.floors import drive_along, feature
from slam.simulation.world import PlanError, build_world, read_plan

SHELL = [feature(box(-0.2, -0.2, 6.2, 4.2).difference(box(0, 0, 6, 4)), "wall", material="rough")]


def plan(*features: Any) -> dict[str, Any]:
    return {"name": "test", "features": [*SHELL, *features]}


def test_free_space_is_what_the_walls_enclose_less_what_stands_in_it() -> None:
    world = build_world(plan(feature(box(1, 1, 2, 2), "obstacle", material="smooth")))
    assert world.free.area == pytest.approx(23.0)
    assert len(world.free.interiors) == 1


def test_every_face_has_free_space_on_its_left_and_its_own_material() -> None:
    world = build_world(plan(feature(box(1, 1, 2, 2), "obstacle", material="smooth")))
    middles = world.surfaces.segments.mean(axis=1)
    left = world.surfaces.tangents @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert shapely.contains_xy(world.free, *(middles + 0.01 * left).T).all()
    inside = (middles > 0.5).all(axis=1) & (middles < 2.5).all(axis=1)
    assert np.all(world.surfaces.roughness[inside] < 1e-3)
    assert np.all(world.surfaces.roughness[~inside] > 1e-3)


def test_a_wall_drawn_in_two_pieces_is_one_face() -> None:
    halves = [feature(box(2, 1, 3, 1.2), "obstacle"), feature(box(3, 1, 4, 1.2), "obstacle")]
    surfaces = build_world(plan(*halves)).surfaces
    lengths = np.linalg.norm(surfaces.segments[:, 1] - surfaces.segments[:, 0], axis=1)
    assert sorted(lengths)[:4] == pytest.approx([0.2, 0.2, 2.0, 2.0])


@pytest.mark.parametrize(("is_open", "area"), [(True, 24 - 1.6 + 0.36), (False, 11.2 + 0.18 * 0.9)])
def test_a_closed_door_parts_the_room_and_an_open_one_does_not(is_open: bool, area: float) -> None:
    line = LineString([(3, 1.5), (3, 2.4)])
    wall = box(2.8, 0, 3.2, 4).difference(line.buffer(0.3, cap_style="flat"))
    pieces = [feature(part, "wall") for part in shapely.get_parts(wall)]
    drive = drive_along([(1, 2), (1.5, 2)])
    world = build_world(plan(*pieces, feature(line, "door", name="d", open=is_open), drive))
    assert world.free.area == pytest.approx(area, abs=0.01)
    assert world.doors[0].name == "d"


def test_beyond_a_boundary_all_is_wall() -> None:
    world = build_world({"features": [feature(box(0, 0, 3, 2), "boundary")]})
    assert world.free.equals(box(0, 0, 3, 2))


@pytest.mark.parametrize(
    ("extra", "message"),
    [
        ({"properties": {"kind": "lamp"}, "geometry": None}, "feature 1 has kind 'lamp'"),
        (feature(LineString([(0, 0), (1, 1)]), "wall"), "feature 1: a wall must be a valid Polygon, not a LineString"),
        (feature(box(1, 1, 2, 2), "obstacle", material="jelly"), "feature 1 has material 'jelly', known materials are"),
        (drive_along([(9, 9), (8, 9)]), "the drive starts at 9, 9, which is not in the enclosed free space"),
        (drive_along([(1, 1), (8, 1), (1, 2)]), "the drive passes through a wall or an obstacle"),
        (drive_along([(1, 1), (2, 1)], headings=[0.0]), "the drive has 2 waypoints, but 1 headings"),
        (drive_along([(1, 1), (2, 1)], headings=["n", "e"]), "the drive's headings and wheels should be numbers"),
        (drive_along([(1, 1), (2, 1)], wheels=[0.1]), "the drive's headings and wheels should be numbers"),
        (drive_along([(1, 1), (2, 1)], step=0), "step = 0 should be a number above 0"),
        (feature(box(1, 1, 2, 2), "obstacle", radius="1 m"), "radius = '1 m' should be a number above 0"),
        ({"properties": {"kind": "wall"}}, "feature 1: the wall has no geometry that can be read"),
        (
            {"properties": {"kind": "drive"}, "geometry": {"type": "LineString", "coordinates": [[1, 1]]}},
            "feature 1: the drive has no geometry that can be read",
        ),
        ([], "feature 1 is no GeoJSON feature with properties"),
    ],
)
def test_a_plan_that_cannot_be_says_which_feature_and_why(extra: Any, message: str, tmp_path: Path) -> None:
    file = tmp_path / "plan.geojson"
    file.write_text(json.dumps(plan(extra)))
    with pytest.raises(PlanError, match=message) as caught:
        read_plan(file)
    assert str(file) in str(caught.value)


def test_a_plan_without_an_inside_is_refused() -> None:
    with pytest.raises(PlanError, match="the 1 walls and obstacles enclose no free space"):
        build_world({"features": [feature(box(0, 0, 1, 1), "wall")]})


def test_a_file_that_is_no_json_is_refused(tmp_path: Path) -> None:
    (tmp_path / "plan.geojson").write_text("{")
    with pytest.raises(PlanError, match=r"plan.geojson: cannot be read as GeoJSON"):
        read_plan(tmp_path / "plan.geojson")


def test_a_file_of_something_else_is_refused(tmp_path: Path) -> None:
    (tmp_path / "plan.geojson").write_text('{"features": null}')
    with pytest.raises(PlanError, match=r"plan.geojson is not a GeoJSON FeatureCollection"):
        read_plan(tmp_path / "plan.geojson")


def test_heights_of_a_drawing_do_no_harm() -> None:
    room = {"type": "Polygon", "coordinates": [[[0, 0, 7], [4, 0, 7], [4, 4, 7], [0, 4, 7], [0, 0, 7]]]}
    world = build_world({"features": [{"properties": {"kind": "boundary"}, "geometry": room}]})
    assert world.surfaces.segments.shape[2] == 2
