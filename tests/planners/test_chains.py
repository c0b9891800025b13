"""Chains of pieces become motions that turn on the spot between legs."""

import numpy as np
from shapely import box

from planners import generalized_cones
from planners.chains import Chain, motion_of, straight
from planners.generalized_cones import ConesSettings
from planners.robot import Robot
from planners.world import World

HALL = World.from_obstacles(box(0, 0, 12, 4), [box(5, 0, 7, 1.5)])
CONES = generalized_cones.prepare(HALL, Robot.rectangle(1.0, 0.5), ConesSettings())
POINTS = tuple(np.array(point, dtype=float) for point in ((0, 0), (2, 0), (4, 0), (4, 3)))


def test_a_motion_goes_straight_at_one_heading_and_turns_between() -> None:
    chain = Chain(POINTS, ((0.0, 0.0), (0.0, 0.0), (1.0, 1.0)), ((-0.1, 0.1), (0.0, 1.0)), 7.0)
    poses = motion_of(chain)
    assert np.allclose(poses, [[0, 0, 0], [4, 0, 0], [4, 0, 1], [4, 3, 1]]), "waypoints on a straight leg are dropped"


def test_a_chain_reversed_twice_is_the_chain() -> None:
    chain = Chain(POINTS, ((0.0, 0.0), (0.5, 0.5), (1.0, 1.0)), ((0.0, 0.5), (0.5, 1.0)), 7.0)
    back = chain.reversed()
    assert np.array_equal(back.points, POINTS[::-1])
    assert back.legs == ((1.0, 1.0), (0.5, 0.5), (0.0, 0.0))
    assert back.reversed().turns == chain.turns


def test_the_straight_way_is_taken_where_some_heading_is_legal_all_along() -> None:
    begin = np.array([1.0, 3.0, 0.0])
    chain = straight(CONES.body, begin, np.array([11.0, 3.0, 0.0]))
    assert chain is not None
    assert chain.cost >= 10 - 1e-9
    assert straight(CONES.body, np.array([1.0, 0.7, 0.0]), np.array([11.0, 0.7, 0.0])) is None
