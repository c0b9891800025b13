import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from planners.certify import certify
from planners.configuration_space import ConfigurationSpaceSettings, plan, prepare, query
from planners.explain import narrowest
from planners.robot import Robot
from planners.world import World
from tests.planners.known_worlds import door, shared_worlds, world_of
from tests.planners.random_worlds import random_pose, random_world

EXACT = ConfigurationSpaceSettings()


def test_round_one_corner_the_way_is_two_tangents_and_an_arc() -> None:
    world = World.from_obstacles(box(0, 0, 20, 20), [box(0, 9.9, 10, 10.1)])
    answer = plan(world, Robot.disc(1), [5, 5, 0], [5, 15, 0], EXACT)
    assert answer.path is not None
    start, radius = np.array([5 - 10, 5 - 9.9]), 1.0
    tangent = np.sqrt(start @ start - radius**2)
    angle = np.arctan2(-start[1], -start[0]) - np.arctan2(radius, tangent)
    bend = np.pi / 2 - angle
    assert answer.path.length == pytest.approx(2 * (tangent + bend * radius) + 0.2, rel=1e-3)
    assert answer.path.clearance < 0.01


def test_discs_do_not_leak_between_walls_that_touch() -> None:
    halves = [box(0, 40, 50, 60), box(50, 40, 100, 60), box(30, 39, 45, 61)]
    world = World.from_obstacles(box(0, 0, 100, 100), halves)
    answer = plan(world, Robot.disc(1e-3), [50, 10, 0], [50, 90, 0], EXACT)
    assert answer.kind == "no path"


def test_a_door_is_passed_up_to_its_width_and_proved_shut_from_one_percent_more() -> None:
    world = door(10)
    assert plan(world, Robot.disc(4.98), [15, 30, 0], [85, 30, 0], EXACT).kind == "path"
    shut = plan(world, Robot.disc(5.06), [15, 30, 0], [85, 30, 0], EXACT)
    assert shut.kind == "no path"
    assert shut.gap is not None
    assert shut.gap.width == pytest.approx(10, abs=1e-3)
    assert shut.gap.needed == pytest.approx(10.12)


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000))
def test_answers_agree_with_the_width_of_the_widest_way(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, robot = random_world(rng), Robot.disc(float(rng.uniform(0.2, 3)))
    start, goal = random_pose(rng, world, robot), random_pose(rng, world, robot)
    if start is None or goal is None:
        return
    answer, width = plan(world, robot, start, goal, EXACT), narrowest(world, start[:2], goal[:2])[0]
    assert answer.path is None or certify(answer.path.poses, robot, world.free)
    if abs(width / 2 / robot.radius - 1) > 0.01:
        assert answer.kind == ("path" if width / 2 > robot.radius else "no path")


def test_the_shared_optima_are_met_to_two_in_ten_thousand() -> None:
    for name in ("room", "office"):
        record = shared_worlds()[name]
        space = prepare(world_of(record), Robot.disc(record["disc_radius"]), EXACT)
        for asked in record["disc_queries"]:
            answer = query(space, [*asked["start"], 0], [*asked["goal"], 0])
            assert answer.path is not None
            assert answer.path.length <= 1.0003 * asked["shortest"]
            assert answer.path.length >= asked["lower_bound"]
