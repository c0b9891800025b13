"""Outlines as arrays: a point lies in a part exactly when no side of it looks at the point."""

import numpy as np
import shapely

from planners.outline import outline_of
from planners.robot import Robot

NOTCHED = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]])


def test_sides_hold_the_points_of_the_robot_and_no_others() -> None:
    robot = Robot.polygons(NOTCHED)
    outline, whole = outline_of(robot), robot.at(np.zeros(3))
    points = np.random.default_rng(0).uniform(-1, 5, (400, 2))
    inside = np.zeros(len(points), np.bool_)
    for first, last in zip(outline.first[:-1], outline.first[1:], strict=True):
        sides = outline.sides[first:last]
        inside |= np.all(points @ sides[:, :2].T <= sides[:, 2], axis=1)
    assert len(outline.first) > 2
    assert np.array_equal(inside, shapely.contains_xy(whole, *points.T))


def test_normals_are_of_unit_length() -> None:
    outline = outline_of(Robot.rectangle(20, 8))
    assert np.allclose(np.hypot(*outline.sides[:, :2].T), 1)
    assert np.allclose(np.sort(outline.sides[:, 2]), [4, 4, 10, 10])


def test_a_disc_is_one_corner_without_a_direction() -> None:
    outline = outline_of(Robot.disc(3))
    assert outline.radius == 3
    assert np.array_equal(outline.sides, [[0, 0, 0]])
