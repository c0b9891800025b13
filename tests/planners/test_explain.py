"""Why there is no path: the narrowest place on the widest way, whose width and walls are known by construction."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from shapely import Point, box

from planners.explain import gap_of, gap_sentence, largest_scale, narrowest, walls_beside
from planners.path import Kind
from planners.robot import Robot
from planners.world import World
from tests.planners.known_worlds import door
from tests.planners.random_worlds import random_pose, random_world

LEFT, RIGHT = np.array([15.0, 30.0]), np.array([85.0, 30.0])


@pytest.mark.parametrize("width", [2.0, 9.0, 17.5])
def test_a_door_is_as_narrow_as_it_was_built_and_that_is_in_the_door(width: float) -> None:
    found, place = narrowest(door(width), LEFT, RIGHT)
    assert 0 <= width - found < 10 * door(width).grid  # to which free space is rounded, on the safe side
    assert 43 <= place[0] <= 57
    assert place[1] == pytest.approx(30, abs=1e-3)


def test_where_an_end_has_less_room_than_any_door_the_end_is_the_narrowest() -> None:
    cramped = np.array([1.0, 30.0])
    found, place = narrowest(door(9), cramped, RIGHT)
    assert found == pytest.approx(2, abs=10 * door(9).grid)
    assert np.array_equal(place, cramped)


def test_the_gap_lies_between_the_two_walls_of_the_door() -> None:
    gap = gap_of(door(9), LEFT, RIGHT, 12.0)
    assert sorted(gap.edges[:, :, 1].mean(axis=1)) == pytest.approx([25.5, 34.5])
    assert "the widest way is 9 m wide; needed are 12 m" in gap_sentence(gap)


def test_the_walls_beside_a_place_are_on_either_side_of_it() -> None:
    world = door(9)
    first, second = world.edges[walls_beside(world, np.array([50.0, 27.0]))]
    assert first[:, 1] == pytest.approx([25.5, 25.5])
    assert second[:, 1] == pytest.approx([34.5, 34.5])


@pytest.mark.parametrize("shelf", [18.0, 17.0])
def test_the_gap_is_the_way_round_and_not_the_thin_wall_that_is_gone_round(shelf: float) -> None:
    """A wall as thin as a hand parts two rooms; the only way leads over a long shelf above its end."""
    shelves = [box(19.95, 0, 20.05, shelf), box(2, shelf, 38, shelf + 0.1)]
    world = World.from_obstacles(box(0, 0, 40, 20), shelves)
    gap = gap_of(world, np.array([10.0, 8.0]), np.array([30.0, 8.0]), 3.5)
    assert gap.width == pytest.approx(min(1.9 + 18 - shelf, 2.0), abs=1e-4)
    if shelf == 18:
        assert sorted(gap.edges[:, :, 1].mean(axis=1)) == pytest.approx([shelf + 0.1, 20], abs=1e-5)
    else:
        assert not 19 < gap.place[0] < 21, "the ends of the shelf are as narrow, the thin wall is no gap"


@pytest.mark.parametrize("seed", [3004, *range(6)])
def test_the_narrowest_place_of_any_world_is_as_wide_as_is_said(seed: int) -> None:
    """In the first world a pose has a ten-thousandth more room than the gap beside it."""
    rng = np.random.default_rng(seed)
    world = random_world(rng)
    poses = [random_pose(rng, world, Robot.disc(0.3)) for _ in range(8)]
    for one, two in pairwise(pose[:2] for pose in poses if pose is not None):
        width, place = narrowest(world, one, two)
        if width > 0:
            assert 2 * shapely.distance(world.boundary, Point(place)) == pytest.approx(width, rel=0.03, abs=1e-6)


def test_walls_that_part_altogether_are_told_so() -> None:
    world = World.from_obstacles(box(0, 0, 40, 20), [box(19.9, 0, 20.1, 20)])
    gap = gap_of(world, np.array([10.0, 8.0]), np.array([30.0, 8.0]), 3.0)
    assert gap.width == 0
    assert gap.place[0] == pytest.approx(20)
    assert "walls part them altogether, such as the one at (20.00, " in gap_sentence(gap)


def test_the_largest_scale_is_found_to_its_steps_and_a_close_call_ends_the_search() -> None:
    def passes(scale: float) -> Kind:
        return "path" if scale < 0.7 else "no path"

    assert largest_scale(passes, 0.2, 12) == pytest.approx(0.7, abs=0.8 / 2**12)
    assert largest_scale(lambda _: "undecided", 0.2, 12) == pytest.approx(0.6)
