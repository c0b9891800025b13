import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.certify import certify
from planners.motion import clearance_of, course_of, keeps
from tests.planners.known_worlds import LONG, door
from tests.planners.random_worlds import random_pose, random_robot, random_world


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000))
def test_two_proofs_that_share_no_code_agree(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, robot = random_world(rng), random_robot(rng)
    course = course_of(world, robot)
    for _ in range(6):
        start, goal = random_pose(rng, world, robot), random_pose(rng, world, robot)
        if start is not None and goal is not None:
            motion = np.array([start, start + 0.3 * (goal - start)])
            assert keeps(course, motion, world.grid) == bool(certify(motion, robot, world.free))


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000))
def test_the_clearance_of_a_path_is_a_tight_lower_bound(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, robot = random_world(rng), random_robot(rng)
    start, goal = random_pose(rng, world, robot), random_pose(rng, world, robot)
    if start is None or goal is None or not certify(np.array([start, goal]), robot, world.free):
        return
    bound = clearance_of(course_of(world, robot), np.array([start, goal]), 1e-3)
    poses = start + np.linspace(0, 1, 301)[:, None] * (goal - start)
    sampled = min(shapely.distance(robot.at(pose), world.free.boundary) for pose in poses)
    assert bound <= sampled + 1e-9
    assert bound >= sampled - 0.1


def test_a_motion_keeps_what_it_keeps_and_no_more() -> None:
    world, motion = door(10), np.array([[30.0, 30, 0], [70, 30, 0]])
    course = course_of(world, LONG)
    assert keeps(course, motion, 0.999)
    assert not keeps(course, motion, 1.001)
    assert clearance_of(course, motion, 1e-3) == pytest.approx(1.0, abs=1e-4)
    assert shapely.box(20, 26, 80, 34).distance(world.free.boundary) == pytest.approx(1.0, abs=1e-4)
