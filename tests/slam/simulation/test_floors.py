import json
from pathlib import Path

import numpy as np
import pytest
from shapely import LineString, Polygon, box

from slam.simulation.floors import ell, pillar, plan_of, walls_around, write_plan
from slam.simulation.world import build_world, read_plan

ROOMS = {"a": box(0, 0, 3, 3), "b": box(3.1, 0, 6, 3)}
DOOR = {"a-b": LineString([(3.05, 1), (3.05, 1.9)])}


def test_rooms_joined_by_a_door_make_one_free_space() -> None:
    world = build_world(plan_of("two", "", walls_around(ROOMS, DOOR, 0.1)))
    assert world.free.area == pytest.approx(9 + 8.7 + 0.09, abs=1e-3)
    assert [room.area for room in world.rooms] == pytest.approx([9, 8.7])


def test_walls_of_a_smooth_room_are_mirrors_on_its_own_side_only() -> None:
    surfaces = build_world(plan_of("two", "", walls_around(ROOMS, DOOR, 0.1, smooth=["b"]))).surfaces
    upright = np.abs(surfaces.tangents[:, 1]) > 0.99
    x = surfaces.segments[:, 0, 0]
    assert np.all(surfaces.roughness[upright & np.isclose(x, 3.0)] > 1e-3)
    assert np.all(surfaces.roughness[upright & np.isclose(x, 3.1)] < 1e-3)


def test_an_l_has_the_area_of_its_two_legs_however_it_is_turned() -> None:
    assert ell((1, 2), 37, 0.6, 0.05).area == pytest.approx(0.05 * (2 * 0.6 - 0.05))


def test_a_pillar_keeps_its_radius_in_the_plan() -> None:
    thing = pillar((1, 1), 0.2)
    assert thing["properties"]["radius"] == 0.2
    assert Polygon(thing["geometry"]["coordinates"][0]).area == pytest.approx(np.pi * 0.04, rel=0.01)


def test_a_plan_file_is_read_as_it_was_drawn(tmp_path: Path) -> None:
    plan = plan_of("two", "rooms", walls_around(ROOMS, DOOR, 0.1))
    write_plan(plan, tmp_path / "plan.geojson")
    assert json.loads((tmp_path / "plan.geojson").read_text()) == json.loads(json.dumps(plan))
    world = read_plan(tmp_path / "plan.geojson")
    assert (world.name, world.description) == ("two", "rooms")
