import numpy as np
from shapely import box

from frontend.rigid_motion import between
from frontend.wall_crossings import crossings_of, poses_of_crossings, wall_crossings
from tests.frontend.rooms import FURNISHED, sketched

CORNER = np.array([[[0.0, 1.0], [2.0, 1.0]], [[3.0, 2.0], [3.0, 4.0]]])


def test_two_walls_cross_where_they_would_meet() -> None:
    assert np.allclose(crossings_of(CORNER), [[3.0, 1.0, 0.0, np.pi / 2]])


def test_parallel_walls_cross_nowhere() -> None:
    walls = sketched(box(-90, 0, 90, 2), np.array([0.0, 1.0, 0.3])).lines
    assert wall_crossings(walls).shape == (0, 4)


def test_one_of_the_poses_proposed_is_the_move_between_two_views() -> None:
    here, there = np.array([2.8, 1.2, 0.2]), np.array([3.3, 1.5, 0.6])
    first, second = wall_crossings(sketched(FURNISHED, here).lines), wall_crossings(sketched(FURNISHED, there, 1).lines)
    off = poses_of_crossings(first, second, 0.2) - between(here, there)
    assert np.min(np.max(np.abs(off), axis=1)) < 0.05


def test_a_corner_seen_from_outside_is_not_one_seen_from_inside() -> None:
    inside, outside = crossings_of(CORNER), crossings_of(CORNER[:, ::-1])
    assert len(poses_of_crossings(inside, inside, 0.2)) == 1
    assert np.allclose(np.abs(poses_of_crossings(inside, outside, 0.2)[:, 2]), np.pi)
