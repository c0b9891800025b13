"""Claims about walls beside doors."""

import numpy as np
import pytest
from shapely import box

from backend.contours import as_polygons
from backend.door_walls import DoorWallSettings, edges_of, goes_on, leads_through, wall_beyond

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
