"""Claims about doors."""

import numpy as np
import pytest
from shapely import MultiPolygon, box

from backend.contours import as_polygons
from backend.doors import DoorSettings, Opening, doors_of, facing_jambs
from backend.sight import sight_of
from tests.backend.plan_rays import furnished_plan

TWO_ROOMS = as_polygons(box(0, 0, 3, 4).union(box(3.1, 0, 6, 4)).union(box(2.9, 1.5, 3.2, 2.4)))
ROOM = MultiPolygon([box(0, 0, 6, 4)])
NOTHING = Opening(np.empty((0, 2, 2)), np.empty(0), np.empty(0, dtype=np.int64))
NOBODY = sight_of([np.array([[9.0, 9.0], [9.1, 9.0], [9.0, 9.1]])], np.array([[9.03, 9.03]]))


def test_facing_jambs_make_a_door_with_its_true_width() -> None:
    (door,) = doors_of(TWO_ROOMS, TWO_ROOMS, NOTHING, NOBODY, DoorSettings())
    assert door.width == pytest.approx(0.9)
    np.testing.assert_allclose(np.sort(door.jambs[:, 1]), [1.5, 2.4], atol=1e-6)
    np.testing.assert_allclose(door.jambs[:, 0], 3.05, atol=1e-6)


def test_a_room_with_a_table_has_no_door() -> None:
    room = as_polygons(box(0, 0, 3, 4).difference(box(0.9, 1, 2, 2)))
    assert doors_of(room, room, NOTHING, NOBODY, DoorSettings()) == ()


def test_wide_passages_and_slits_are_no_doors() -> None:
    for low, high in ((1.0, 3.0), (1.5, 1.8)):
        rooms = as_polygons(box(0, 0, 3, 4).union(box(3.1, 0, 6, 4)).union(box(2.9, low, 3.2, high)))
        assert len(facing_jambs(rooms, DoorSettings()).jambs) == 0


def test_openings_that_views_report_at_one_place_become_one_door() -> None:
    room = as_polygons(ROOM.union(box(1, -1, 1.9, 0)).union(box(6, 2.5, 7, 3.3)))
    jambs = np.array([[[1.0, 0.0], [1.9, 0.0]], [[1.92, 0.02], [1.04, 0.02]], [[6.0, 2.5], [6.0, 3.3]]])
    reported = Opening(jambs, np.ones(3), np.array([4, 7, 7]))
    one, other = doors_of(room, room, reported, NOBODY, DoorSettings())
    np.testing.assert_allclose(one.jambs, [[1.02, 0.01], [1.91, 0.01]])
    assert one.views.tolist() == [4, 7]
    assert one.confidence > other.confidence


def test_a_gap_in_whose_line_no_wall_goes_on_is_no_door() -> None:
    reported = Opening(np.array([[[0.0, 1.0], [0.7, 0.3]], [[3.0, 1.5], [3.9, 1.5]]]), np.ones(2), np.array([4, 7]))
    assert doors_of(ROOM, ROOM, reported, NOBODY, DoorSettings()) == ()


def test_an_opening_that_leads_nowhere_is_no_door() -> None:
    reported = Opening(np.array([[[1.0, 0.0], [1.9, 0.0]]] * 6), np.ones(6), np.arange(6))
    assert doors_of(ROOM, ROOM, reported, NOBODY, DoorSettings()) == ()


def test_a_gap_beside_a_cupboard_that_few_views_took_for_a_door_is_none() -> None:
    room = as_polygons(box(0, 0, 6, 4).difference(box(0, 1.5, 2, 2)))
    gap = np.array([[[2.0, 1.75], [3.2, 1.75]]])
    assert doors_of(room, room, Opening(gap, np.ones(1), np.array([3])), NOBODY, DoorSettings()) == ()


@pytest.mark.parametrize("seed", range(4))
def test_all_doors_of_a_true_plan_are_found_and_nothing_else(seed: int) -> None:
    plan = furnished_plan(np.random.default_rng(seed), 6, obstacles=0)
    free = MultiPolygon([plan.free])
    doors = doors_of(free, free, NOTHING, NOBODY, DoorSettings())
    middles = np.array([door.jambs.mean(axis=0) for door in doors])
    distance = np.linalg.norm(middles[:, None] - plan.doors.mean(axis=1)[None], axis=2)
    assert distance.min(axis=0).max() < 0.1
    assert distance.min(axis=1).max() < 0.1
