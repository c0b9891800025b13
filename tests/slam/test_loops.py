"""Loops: an old place is recognised from metres off, and each way of being wrong is refused with its reason."""

import numpy as np
import pytest
from shapely import Polygon, box

from frontend.local_map import Faces
from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from frontend.scan import Floats, Scan
from frontend.sensors.lidar import LIDAR
from slam.loops import VerificationSettings, close_loop
from slam.perception import FrontendSettings, Percept, perceive
from slam.simulation.record import lidar_scan
from slam.simulation.world import World
from tests.simulated_drives import BEARINGS, corridor, faces_from, world_of

SETTINGS = VerificationSettings()
ROOM = box(0, 0, 7, 5)
FURNITURE = (box(1, 0, 2, 0.7), box(6.3, 2, 7, 3.2), box(3, 4.5, 4.5, 5), box(0, 3, 0.4, 3.8))
HERE = np.array([3.2, 2.4, 0.5])


def room(*more: Polygon) -> World:
    return world_of(ROOM, *FURNITURE, *more)


def tried(now: World, then: World, shift: Floats, window: tuple[float, float]) -> Alignment | str:
    """A scan at HERE in `now`, believed to be off by `shift` (3,), laid on what was once seen of `then`."""
    rng = np.random.default_rng(1)
    percept = seen_at(now, HERE, rng)
    believed = compose(HERE, shift)
    recent = faces_from(now, [HERE, compose(HERE, np.array([-0.3, 0, 0]))], rng)
    moved = recent.moved(compose(believed, between(HERE, np.zeros(3))))
    old = faces_from(then, [HERE + np.array([0.4, -0.2, 1.0]), HERE + np.array([-0.5, 0.2, -1.0])], rng)
    return close_loop(percept, believed, moved, old, window, SETTINGS)


def seen_at(world: World, pose: Floats, rng: np.random.Generator) -> Percept:
    scan = Scan(BEARINGS, lidar_scan(world, pose, LIDAR, rng), LIDAR, np.zeros(3), 0.0)
    return perceive(scan, FrontendSettings())


@pytest.mark.parametrize(
    ("shift", "window"),
    [
        ((0.1, -0.1, 0.05), (0.3, 0.1)),
        ((0.8, -0.6, 0.15), (1.5, 0.3)),
        ((-1.7, 1.2, -0.25), (2.5, 0.4)),
    ],
)
def test_the_same_place_is_recognised_from_metres_off(
    shift: tuple[float, float, float], window: tuple[float, float]
) -> None:
    found = tried(room(), room(), np.array(shift), window)
    assert isinstance(found, Alignment)
    error = between(HERE, found.pose_in_fixed)
    assert np.hypot(*error[:2]) < 0.01
    assert abs(error[2]) < 0.005


def test_another_place_is_refused() -> None:
    elsewhere = world_of(Polygon([(-2, -3), (8, -2), (9, 7), (3, 9), (-1, 6)]), box(1, 5, 2, 6))
    for window in ((0.3, 0.1), (2.0, 0.3)):
        assert isinstance(tried(room(), elsewhere, np.zeros(3), window), str)


def test_walls_where_the_scan_looks_through_are_refused() -> None:
    """The old room was divided by a wall near the robot that is not there now."""
    refused = tried(room(), room(box(4.3, 0, 4.4, 4)), np.zeros(3), (0.3, 0.1))
    assert isinstance(refused, str)
    assert "%" in refused


def in_corridor(window: tuple[float, float]) -> Alignment | str:
    """A scan in a long corridor, laid on what was seen there half a metre before and behind."""
    rng = np.random.default_rng(2)
    here = np.array([30.0, 1.0, 0.0])
    percept = seen_at(corridor(), here, rng)
    old = faces_from(corridor(), [here - np.array([0.5, 0, 0]), here + np.array([0.5, 0, 0])], rng)
    return close_loop(percept, here, Faces.placed(percept.surface, here), old, window, SETTINGS)


def test_a_long_corridor_ties_across_and_in_heading_but_not_along() -> None:
    found = in_corridor((0.3, 0.1))
    assert isinstance(found, Alignment)
    along, across, heading = np.sqrt(np.diag(np.linalg.inv(found.information)))
    assert along > 0.3
    assert across < 0.02
    assert heading < 0.01


def test_a_long_corridor_is_refused_where_the_doubt_is_wider_than_a_corridor() -> None:
    refused = in_corridor((1.5, 0.1))
    assert isinstance(refused, str)
    assert "free to slide" in refused


def test_where_nothing_looks_this_way_it_is_said() -> None:
    refused = tried(room(), room(), np.array([40.0, 0, 0]), (0.3, 0.1))
    assert isinstance(refused, str)
    assert "old faces look this way" in refused


def test_a_window_without_the_place_in_it_is_said_with_its_size() -> None:
    refused = tried(room(), room(), np.array([20.0, 0, 0]), (1.0, 0.2))
    assert isinstance(refused, str)
    assert "within 1.0 m and 11°" in refused


def test_a_map_seen_only_from_the_other_side_of_its_walls_is_refused() -> None:
    rng = np.random.default_rng(3)
    percept = seen_at(room(), HERE, rng)
    old = faces_from(room(), [HERE], rng)
    behind = Faces(old.points, -old.normals)
    refused = close_loop(percept, HERE, Faces.placed(percept.surface, HERE), behind, (0.3, 0.1), SETTINGS)
    assert isinstance(refused, str)


def test_a_blind_scan_is_refused() -> None:
    rng = np.random.default_rng(4)
    blind = perceive(Scan(BEARINGS, np.full(360, np.inf), LIDAR, np.zeros(3), 0.0), FrontendSettings())
    old = faces_from(room(), [HERE], rng)
    assert isinstance(close_loop(blind, HERE, old, old, (0.3, 0.1), SETTINGS), str)
