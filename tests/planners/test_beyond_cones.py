"""Where a motion goes beyond the cones, in worlds whose cones are known."""

import numpy as np
import pytest
from shapely import box

from planners.beyond_cones import beyond
from planners.generalized_cones import ConesSettings, drawn, prepare
from planners.path import Cone
from planners.robot import Robot
from planners.world import World
from tests.planners.known_worlds import LONG, diagonal

CORRIDOR = World.from_obstacles(box(0, 0, 100, 12), [])
ALONG, ACROSS = 0.0, np.pi / 2


def cones_of(world: World, robot: Robot) -> tuple[Cone, ...]:
    return drawn(prepare(world, robot, ConesSettings()))


def test_slices_keep_a_motion_along_a_corridor() -> None:
    poses = np.array([[20, 6, ALONG], [80, 6, ALONG], [80, 6, ALONG + 0.1]])
    assert beyond(cones_of(CORRIDOR, LONG), poses, 1.0, LONG.reach) is None
    assert beyond(cones_of(CORRIDOR, LONG), poses - [0, 0, 2 * np.pi], 1.0, LONG.reach) is None


def test_a_corridor_loses_the_headings_at_which_the_robot_is_wider_than_it() -> None:
    poses = np.array([[20, 6, ALONG], [50, 6, ALONG], [50, 6, ACROSS], [50, 6, ALONG], [80, 6, ALONG]])
    found = beyond(cones_of(CORRIDOR, LONG), poses, 1.0, LONG.reach)
    assert found is not None
    assert found.pose == pytest.approx([50, 6, ACROSS], abs=0.1)
    assert found.slices >= 1
    assert found.width == pytest.approx(12, abs=1e-5)
    # A corner 10 ahead and 4 aside of the middle touches a wall 6 off at this heading.
    legal = np.arcsin(6 / np.hypot(10, 4)) - np.arctan2(4, 10)
    assert found.lost == pytest.approx([legal, np.pi - legal], abs=1e-6)


def test_no_cone_covers_where_rooms_meet_at_their_corners() -> None:
    poses = np.array([[16, 44, 0], [44, 16, 0.0]])
    found = beyond(cones_of(diagonal(), Robot.disc(2.5)), poses, 0.5, 2.5)
    assert found is not None
    assert found.slices == 0
    assert found.pose == pytest.approx([30, 30, 0], abs=0.5)
    assert beyond(cones_of(diagonal(), Robot.disc(1.0)), poses, 0.5, 1.0) is None


def test_without_cones_every_place_is_beyond_them() -> None:
    found = beyond((), np.array([[0, 0, 0], [4, 0, 0.0]]), 0.5, 1.0)
    assert found is not None
    assert found.pose == pytest.approx([2, 0, 0], abs=0.5)


def test_a_stretch_on_the_way_counts_before_longer_ones_at_the_ends() -> None:
    poses = np.array([[2, 2, 0], [20, 6, 0], [50, 6, 0], [50, 6, ACROSS], [50, 6, 0], [80, 6, 0.0]])
    found = beyond(cones_of(CORRIDOR, LONG), poses, 0.05, 1.0)
    assert found is not None
    assert found.pose[0] == pytest.approx(50, abs=1)
