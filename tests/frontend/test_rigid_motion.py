"""Rigid motions of the plane form a group, and move points without bending anything."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from frontend.rigid_motion import between, compose, inverse, rotation, transform, wrap
from frontend.scan import Floats

coordinate = st.floats(-100, 100)
poses = st.builds(lambda *pose: np.array(pose), coordinate, coordinate, st.floats(-10, 10))
point_lists = st.lists(st.tuples(coordinate, coordinate), min_size=2, max_size=8).map(np.array)
laws = settings(deadline=None, max_examples=50)


def assert_same_pose(first: Floats, second: Floats) -> None:
    np.testing.assert_allclose(first[:2], second[:2], atol=1e-9)
    assert abs(float(wrap(first[2] - second[2]))) < 1e-9


@laws
@given(st.floats(-1e4, 1e4))
def test_a_wrapped_angle_points_the_same_way_and_lies_within_half_a_turn(angle: float) -> None:
    wrapped = float(wrap(np.asarray(angle)))
    assert -np.pi <= wrapped <= np.pi  # a hair over half a turn rounds to −π
    np.testing.assert_allclose([np.cos(wrapped), np.sin(wrapped)], [np.cos(angle), np.sin(angle)], atol=1e-9)
    assert float(wrap(np.asarray(wrapped))) == wrapped


def test_half_a_turn_is_positive() -> None:
    np.testing.assert_array_equal(wrap(np.array([np.pi, -np.pi, 3 * np.pi])), np.pi)


@laws
@given(poses)
def test_a_motion_and_its_inverse_leave_everything_where_it_was(pose: Floats) -> None:
    assert_same_pose(compose(pose, inverse(pose)), np.zeros(3))
    assert_same_pose(compose(inverse(pose), pose), np.zeros(3))
    assert_same_pose(inverse(inverse(pose)), pose)


@laws
@given(poses, poses, poses)
def test_motions_compose_in_any_grouping(first: Floats, second: Floats, third: Floats) -> None:
    assert_same_pose(compose(compose(first, second), third), compose(first, compose(second, third)))


@laws
@given(poses, poses)
def test_between_is_what_leads_from_the_first_to_the_second(first: Floats, second: Floats) -> None:
    assert_same_pose(compose(first, between(first, second)), second)
    assert_same_pose(between(second, first), inverse(between(first, second)))


@laws
@given(point_lists, poses, poses)
def test_moving_points_twice_is_moving_them_by_the_composed_motion(
    points: Floats, first: Floats, second: Floats
) -> None:
    np.testing.assert_allclose(
        transform(transform(points, second), first), transform(points, compose(first, second)), atol=1e-8
    )


@laws
@given(point_lists, poses)
def test_a_motion_keeps_distances(points: Floats, pose: Floats) -> None:
    moved = transform(points, pose)
    np.testing.assert_allclose(
        np.linalg.norm(moved - moved[0], axis=1), np.linalg.norm(points - points[0], axis=1), atol=1e-8
    )


def test_a_quarter_turn_is_counter_clockwise() -> None:
    np.testing.assert_allclose(rotation(np.pi / 2) @ [1, 0], [0, 1], atol=1e-15)
    np.testing.assert_allclose(transform(np.array([[2.0, 1.0]]), np.array([10, 20, np.pi / 2])), [[9, 22]], atol=1e-12)


def test_arguments_are_not_written_into() -> None:
    first, second = np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0])
    for motion in (compose, between):
        motion(first, second)
    inverse(first)
    np.testing.assert_array_equal(first, [1, 2, 3])
    np.testing.assert_array_equal(second, [4, 5, 6])
