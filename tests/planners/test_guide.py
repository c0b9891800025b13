"""How far it is to the goal for a disc, on a raster."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.configuration_space import ConfigurationSpaceSettings, plan
from planners.guide import guide_to, left
from planners.robot import Robot
from tests.planners.known_worlds import door
from tests.planners.random_worlds import random_pose, random_world

GOAL = np.array([85.0, 15, 0])


def test_the_guide_leads_through_a_door_that_the_disc_passes_and_not_through_a_narrower_one() -> None:
    here = np.array([15.0, 15, 0])
    open_door, shut = guide_to(door(10), 4.0, GOAL), guide_to(door(4), 4.0, GOAL)
    corner = np.hypot(43 - 15, 29 - 15)
    assert left(open_door, here) == pytest.approx(2 * corner + 14, rel=0.05)
    assert left(shut, here) > 1.5 * left(open_door, here)


def test_a_point_is_led_around_walls_too() -> None:
    around = left(guide_to(door(10), 0.0, GOAL), np.array([42.0, 5, 0]))
    assert around > np.hypot(85 - 42, 10) + 10


@settings(deadline=None, max_examples=10)
@given(st.integers(0, 10_000))
def test_no_disc_has_a_shorter_way_than_the_guide_says_but_for_its_sixteen_directions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, disc = random_world(rng), Robot.disc(2.0)
    start, goal = random_pose(rng, world, disc), random_pose(rng, world, disc)
    if start is None or goal is None:
        return
    path = plan(world, disc, start, goal, ConfigurationSpaceSettings()).path
    if path is not None:
        guide = guide_to(world, disc.radius, goal)
        assert left(guide, start) <= 1.03 * path.length + 4 * guide.step
        assert left(guide, start) >= 0.97 * np.linalg.norm(goal[:2] - start[:2]) - 4 * guide.step
