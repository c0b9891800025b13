from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Polygon, box

from planners.certify import certify
from planners.configuration_space import ConfigurationSpaceSettings, plan, prepare, query
from planners.path import PlanningError
from planners.robot import Robot
from planners.world import World
from tests.planners.flood_fill import refutations
from tests.planners.known_worlds import CRITICAL_CORNER, LONG, corner, corner_query, door, shared_worlds, world_of
from tests.planners.random_worlds import random_pose, random_robot, random_world

FINE = ConfigurationSpaceSettings(resolution=0.1)
START, GOAL = [15, 45, 1.2], [85, 15, -2.0]


@pytest.mark.parametrize("width", [10, 9, 8.5])
def test_a_door_wider_than_the_robot_is_passed_and_the_motion_proved(width: float) -> None:
    answer = plan(door(width), LONG, START, GOAL, FINE)
    assert answer.path is not None
    assert certify(answer.path.poses, LONG, door(width).free)
    assert np.allclose(answer.path.poses[0], START)


def test_a_door_narrower_than_the_robot_is_proved_shut_and_the_gap_named() -> None:
    answer = plan(door(7.9), LONG, START, GOAL, FINE)
    assert answer.kind == "no path"
    assert answer.gap is not None
    assert answer.gap.width == pytest.approx(7.9, abs=1e-3)
    assert answer.gap.needed == pytest.approx(8)
    assert "7.9 m wide; needed are 8 m" in answer.reason


def test_walls_that_part_a_large_world_are_proved_at_once() -> None:
    world = World.from_obstacles(box(0, 0, 1000, 1000), [box(499, 0, 501, 600), box(499, 600, 501, 1000)])
    answer = plan(world, LONG, [100, 100, None], [900, 900, None], replace(FINE, most_boxes=100))
    assert answer.kind == "no path"
    assert "walls part them altogether" in answer.reason


def test_the_corner_turns_at_its_critical_width_to_three_resolutions() -> None:
    width = CRITICAL_CORNER + 3 * FINE.resolution
    assert plan(corner(width), LONG, *corner_query(width), FINE).kind == "path"
    width = CRITICAL_CORNER - 3 * FINE.resolution
    answer = plan(corner(width), LONG, *corner_query(width), FINE)
    assert answer.kind == "no path"
    assert answer.gap is not None
    assert answer.gap.width == pytest.approx(width, abs=0.1)
    assert answer.gap.needed == pytest.approx(CRITICAL_CORNER, abs=0.3)


def test_clearance_that_is_asked_for_is_kept_and_can_shut_a_door() -> None:
    careful = replace(FINE, clearance=0.2)
    answer = plan(door(9), LONG, START, GOAL, careful)
    assert answer.path is not None
    assert answer.path.clearance >= 0.2
    assert certify(answer.path.poses, LONG.grown(0.19), door(9).free)
    assert plan(door(9), LONG, START, GOAL, replace(FINE, clearance=0.6)).kind == "no path"


def test_too_coarse_a_resolution_says_undecided_and_not_that_there_is_no_path() -> None:
    answer = plan(door(8.2), LONG, START, GOAL, replace(FINE, resolution=2.0))
    assert answer.kind == "undecided"
    assert "2 m" in answer.reason


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000))
def test_every_path_is_free_and_no_path_is_never_said_where_a_big_disc_passes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, robot = random_world(rng), random_robot(rng)
    coarse = ConfigurationSpaceSettings(resolution=0.5, smaller_robots=0, most_boxes=40_000)
    start, goal = random_pose(rng, world, robot), random_pose(rng, world, robot)
    if start is None or goal is None:
        return
    answer = plan(world, robot, start, goal, coarse)
    assert answer.path is None or certify(answer.path.poses, robot, world.free)
    if answer.kind == "no path":
        enclosing = Robot.disc(robot.reach)
        try:
            assert plan(world, enclosing, start, goal, coarse).kind != "path"
        except PlanningError:
            return


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 10_000))
def test_every_corridor_with_clearance_above_the_stated_multiple_is_solved(seed: int) -> None:
    rng = np.random.default_rng(seed)
    settings_, robot = ConfigurationSpaceSettings(resolution=0.2), Robot.rectangle(3, 1)
    world, start, goal = bent_corridor(rng, width=1 + 2 * 2.42 * 0.2 * 1.05 + 0.02)
    assert plan(world, robot, start, goal, settings_).kind == "path"


def bent_corridor(rng: np.random.Generator, width: float) -> tuple[World, np.ndarray, np.ndarray]:
    """A straight corridor of any direction between two halls where the robot can turn."""
    angle = rng.uniform(0, np.pi)
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    blocks = [
        np.array([30 * u * along + v * across for u, v in ((-0.4, s), (0.4, s), (0.4, 100 * s), (-0.4, 100 * s))])
        for s in (width / 2, -width / 2)
    ]
    world = World.from_obstacles(box(-20, -20, 20, 20), [Polygon(block) for block in blocks])
    return world, np.append(-17 * along, rng.uniform(0, 6)), np.append(17 * along, rng.uniform(0, 6))


def test_boxes_of_one_query_serve_the_next() -> None:
    space = prepare(door(9), LONG, FINE)
    there, back = query(space, START, GOAL), query(space, GOAL, START)
    assert there.path is not None
    assert back.path is not None
    assert certify(back.path.poses, LONG, door(9).free)


def test_a_free_heading_may_end_either_way_round() -> None:
    answer = plan(door(9), LONG, [15, 45, None], [85, 15, None], FINE)
    assert answer.path is not None
    assert certify(answer.path.poses, LONG, door(9).free)


def test_a_world_away_from_the_origin_is_the_same() -> None:
    moved = World.from_obstacles(
        box(-300, -160, -200, -100), [box(-257, -160, -243, -135), box(-257, -125, -243, -100)]
    )
    answer = plan(moved, LONG, [-285, -115, 1.2], [-215, -145, -2.0], FINE)
    assert answer.path is not None
    assert certify(answer.path.poses, LONG, moved.free)


def test_rotated_rectangles_of_the_shared_worlds_are_solved_close_to_the_best_known() -> None:
    for name in ("room", "office"):
        record = shared_worlds()[name]
        world, robot = world_of(record), Robot.rectangle(*record["rectangle"])
        asked = record["rectangle_queries"][0]
        answer = plan(world, robot, asked["start"], asked["goal"], FINE)
        assert answer.path is not None
        assert answer.path.length < 1.05 * asked["best_known_length"]
        assert certify(answer.path.poses, robot, world.free)


@pytest.mark.parametrize("seed", range(3))
def test_no_proof_is_refuted_by_flooding_a_fine_grid(seed: int) -> None:
    assert refutations(np.random.default_rng(seed), queries=4, step=1.0)["refuted"] == 0
