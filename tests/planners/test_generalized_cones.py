import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.certify import certify
from planners.generalized_cones import ConesSettings, drawn, plan, prepare, query
from planners.path import PlanningError
from planners.robot import Robot
from tests.planners.known_worlds import LONG, corner, corner_query, door, shared_worlds, world_of
from tests.planners.random_worlds import random_pose, random_robot, random_world


def test_a_rectangle_goes_through_a_door_and_turns_where_spines_cross() -> None:
    answer = plan(door(9), LONG, [15, 45, 1.2], [85, 15, -2.0], ConesSettings())
    assert answer.path is not None
    assert certify(answer.path.poses, LONG, door(9).free)
    assert np.allclose(answer.path.poses[0], [15, 45, 1.2])
    assert np.cos(answer.path.poses[-1, 2] + 2.0) == pytest.approx(1)


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000))
def test_every_path_is_free_as_a_whole(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, robot = random_world(rng), random_robot(rng)
    cones = prepare(world, robot, ConesSettings(shortcuts=int(rng.choice([0, 30]))))
    for _ in range(4):
        start, goal = random_pose(rng, world, robot), random_pose(rng, world, robot)
        if start is not None and goal is not None:
            answer = query(cones, start, goal)
            assert answer.kind in {"path", "not found"}
            assert answer.path is None or certify(answer.path.poses, robot, world.free)


def test_not_found_names_the_place_and_the_headings_that_are_lost() -> None:
    answer = plan(door(7.9), LONG, [15, 45, 1.2], [85, 15, -2.0], ConesSettings())
    assert answer.kind == "not found"
    assert "°" in answer.reason
    assert "(" in answer.reason


def test_a_corner_that_needs_both_motions_at_once_is_beyond_spines() -> None:
    answer = plan(corner(13), LONG, *corner_query(13), ConesSettings())
    assert answer.kind == "not found"
    assert "by no spine can a crossing be reached from the start" in answer.reason, "it stands on one"


def test_cones_are_drawn_inside_free_space_with_their_spines() -> None:
    world = door(9)
    cones = drawn(prepare(world, LONG, ConesSettings()))
    assert cones
    for cone in cones:
        outline = shapely.make_valid(shapely.Polygon(cone.outline))
        assert outline.difference(world.free.buffer(1e-3)).area < 1e-2 * outline.area
        assert world.free.covers(shapely.linestrings(cone.spine))


def test_a_free_heading_at_both_ends_needs_no_turn_in_a_corridor() -> None:
    answer = plan(corner(14), LONG, [12, 7, None], [40, 7, np.nan], ConesSettings())
    assert answer.path is not None
    assert answer.path.turning == 0


def test_a_start_in_a_wall_is_refused_with_its_depth() -> None:
    with pytest.raises(PlanningError, match=r"start \(50, 10\) lies 7 m outside"):
        plan(door(10), Robot.disc(1), [50, 10, 0], [85, 15, 0], ConesSettings())
    with pytest.raises(PlanningError, match=r"goal .* overlaps an obstacle"):
        plan(door(10), LONG, [15, 45, 1.2], [92, 15, 0], ConesSettings())


def test_all_feasible_disc_queries_of_the_shared_worlds_are_solved() -> None:
    for name in ("room", "office"):
        record = shared_worlds()[name]
        world, robot = world_of(record), Robot.disc(record["disc_radius"])
        cones = prepare(world, robot, ConesSettings())
        for asked in record["disc_queries"]:
            answer = query(cones, [*asked["start"], None], [*asked["goal"], None])
            assert answer.path is not None
            assert certify(answer.path.poses, robot, world.free)
            assert answer.path.length < 2 * asked["shortest"]
