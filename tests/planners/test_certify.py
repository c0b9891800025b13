import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.certify import certify
from planners.robot import Robot
from tests.planners.known_worlds import LONG, door
from tests.planners.random_worlds import random_pose, random_robot, random_world


def test_a_motion_through_the_middle_of_a_door_is_certified() -> None:
    assert certify(np.array([[30.0, 30, 0], [70, 30, 0]]), LONG, door(8.01).free)


def test_a_motion_that_scrapes_the_jamb_collides_and_says_where() -> None:
    verdict = certify(np.array([[15.0, 31, 0], [85, 31, 0]]), LONG, door(9).free)
    assert verdict.verdict == "collision"
    assert verdict.witness is not None
    assert 33 < verdict.witness[0] < 67


def test_a_turn_that_sweeps_a_wall_between_free_poses_is_found() -> None:
    poses = np.array([[50.0, 30, 0], [50, 30, np.pi]])
    assert certify(poses[:1], LONG, door(9).free)
    assert certify(poses[1:], LONG, door(9).free)
    assert certify(poses, LONG, door(9).free).verdict == "collision"


def test_a_disc_that_only_just_fits_is_certified_and_one_that_touches_is_not() -> None:
    poses = np.array([[30.0, 30, 0], [70, 30, 0]])
    assert certify(poses, Robot.disc(4.9999), door(10).free)
    assert not certify(poses, Robot.disc(5.0), door(10).free)


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000))
def test_what_is_certified_holds_at_every_sampled_pose(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, robot = random_world(rng), random_robot(rng)
    start, goal = random_pose(rng, world, robot), random_pose(rng, world, robot)
    if start is None or goal is None or not certify(np.array([start, goal]), robot, world.free):
        return
    for share in np.linspace(0, 1, 101):
        assert shapely.covers(world.free, robot.at(start + share * (goal - start)))
