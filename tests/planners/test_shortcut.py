import numpy as np

from planners.certify import certify
from planners.motion import course_of
from planners.path import Path
from planners.shortcut import shortened
from tests.planners.known_worlds import LONG, door


def test_a_detour_becomes_the_straight_way_and_stays_free() -> None:
    world = door(10)
    detour = np.array([[15.0, 30, 0], [15, 50, 0], [30, 50, 0], [30, 30, 0], [70, 30, 0], [85, 30, 0]])
    shorter = shortened(course_of(world, LONG), detour, world.grid, 0.1, 50)
    assert Path(shorter, 0, "").length < 70.001
    assert np.array_equal(shorter[[0, -1]], detour[[0, -1]])


def test_a_corner_that_cannot_be_cut_is_kept_as_tight_as_the_clearance() -> None:
    world = door(10)
    bent = np.array([[20.0, 50, 0], [20, 30, 0], [80, 30, 0], [80, 50, 0]])
    shorter = shortened(course_of(world, LONG), bent, 0.5, 0.1, 200)
    assert 60 < Path(shorter, 0, "").length < 99
    assert certify(shorter, LONG.grown(0.499), world.free)
