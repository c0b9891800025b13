"""Claims about walls beside doors."""

import numpy as np
import pytest
from shapely import box
from shapely.affinity import rotate

from backend.contours import as_polygons
from backend.door_walls import (
    DoorWallSettings,
    edges_of,
    goes_on,
    in_the_middle,
    leads_through,
    on_the_wall,
    wall_beyond,
)

TWO_ROOMS = as_polygons(box(0, 0, 3, 4).union(box(3.1, 0, 6, 4)).union(box(2.9, 1.5, 3.2, 2.4)))
DOOR = np.array([[[3.05, 1.5], [3.05, 2.4]]])
IN_THE_ROOM = np.array([[[1.0, 1.5], [1.0, 2.4]]])
AT_A_WALL = np.array([[[0.0, 1.5], [0.0, 2.4]]])


def test_a_door_leads_through_and_a_piece_of_wall_does_not() -> None:
    found = leads_through(TWO_ROOMS, np.concatenate([DOOR, IN_THE_ROOM, AT_A_WALL]), DoorWallSettings())
    assert found.tolist() == [True, True, False]


def test_the_wall_beyond_a_jamb_is_measured_within_a_metre_on_both_its_faces() -> None:
    edges = edges_of(TWO_ROOMS)
    assert wall_beyond(edges, DOOR, DoorWallSettings())[0] == pytest.approx(2.0)
    assert wall_beyond(edges, IN_THE_ROOM, DoorWallSettings())[0] == 0.0


def test_a_wall_goes_on_from_a_door_and_not_from_a_place_in_the_room() -> None:
    edges = edges_of(TWO_ROOMS)
    assert goes_on(edges, np.concatenate([DOOR, IN_THE_ROOM]), DoorWallSettings()).tolist() == [True, False]


def test_a_jamb_that_hangs_in_free_ground_is_put_where_the_wall_of_the_other_one_goes_on() -> None:
    reported = np.array([[3.05, 1.5], [2.70, 2.15]])
    placed = on_the_wall(TWO_ROOMS, reported, (0.55, 1.4), DoorWallSettings())
    np.testing.assert_allclose(placed, [[3.05, 1.5], [3.05, 2.4]], atol=0.02)


def test_jambs_on_the_wall_stay_and_so_do_two_in_the_air() -> None:
    in_the_air = np.array([[1.0, 1.5], [1.0, 2.4]])
    for jambs in (DOOR[0], in_the_air):
        np.testing.assert_array_equal(on_the_wall(TWO_ROOMS, jambs, (0.55, 1.4), DoorWallSettings()), jambs)


@pytest.mark.parametrize("turn", [0.0, 33.0])
@pytest.mark.parametrize("jambs", [[[3.0, 1.5], [3.1, 2.4]], [[3.1, 1.5], [3.0, 2.4]], [[3.0, 1.5], [3.0, 2.4]]])
def test_jambs_on_either_face_of_a_wall_are_drawn_to_its_middle_line(jambs: list[list[float]], turn: float) -> None:
    def turned(points: object) -> np.ndarray:
        cosine, sine = np.cos(np.radians(turn)), np.sin(np.radians(turn))
        return np.asarray(np.array(points) @ np.array([[cosine, sine], [-sine, cosine]]))

    rooms = as_polygons(rotate(TWO_ROOMS, turn, origin=(0, 0)))
    middle = in_the_middle(rooms, turned(jambs), 0.4, DoorWallSettings())
    np.testing.assert_allclose(middle, turned([[3.05, 1.5], [3.05, 2.4]]), atol=2e-3)


def test_a_door_stays_where_a_wall_beside_it_has_no_other_face() -> None:
    niche = as_polygons(box(0, 0, 3, 4).union(box(2.9, 1.5, 4, 2.4)))
    jambs = np.array([[3.0, 1.5], [3.0, 2.4]])
    np.testing.assert_array_equal(in_the_middle(niche, jambs, 0.4, DoorWallSettings()), jambs)
