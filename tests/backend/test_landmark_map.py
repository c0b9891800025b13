"""Landmarks: knots seen again are matched, and one corner never becomes two landmarks."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.landmark_map import Knots, LandmarkMap, LandmarkSettings
from frontend.rigid_motion import inverse, transform, wrap
from frontend.scan import Floats

SETTINGS = LandmarkSettings()
SPREAD = 0.02


def corners(rng: np.random.Generator, count: int) -> tuple[Floats, Floats, Floats]:
    """Places (l, 2) at least a metre apart, turns (l,) and headings (l,) of the corners of a room."""
    grid = np.stack(np.meshgrid(np.arange(6.0), np.arange(6.0)), axis=-1).reshape(-1, 2) * 1.5
    places = rng.permutation(grid)[:count] + rng.uniform(-0.2, 0.2, (count, 2))
    return places, rng.choice([-np.pi / 2, np.pi / 2], count), rng.uniform(-np.pi, np.pi, count)


def seen_from(pose: Floats, world: tuple[Floats, Floats, Floats], rng: np.random.Generator) -> Knots:
    """The corners as knots of a scan at a pose (3,), with noise."""
    places, turns, headings = world
    count = len(places)
    return Knots(
        transform(places, inverse(pose)) + rng.normal(0, SPREAD, (count, 2)),
        turns + rng.normal(0, 0.05, count),
        np.asarray(wrap(headings - pose[2] + rng.normal(0, 0.05, count))),
        np.tile(np.eye(2) * SPREAD**2, (count, 1, 1)),
    )


def knot(x: float, y: float, turn: float = 1.5, heading: float = 0.0) -> Knots:
    return Knots(np.array([[x, y]]), np.array([turn]), np.array([heading]), np.eye(2)[None] * SPREAD**2)


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(1, 12))
def test_corners_seen_from_anywhere_are_matched_and_never_doubled(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    (places, turns, headings), landmarks = corners(rng, count), LandmarkMap(SETTINGS)
    sightings = []
    for k in range(10):
        pose = np.array([*rng.uniform(0, 8, 2), rng.uniform(-np.pi, np.pi)])
        order = rng.permutation(count)
        sightings += landmarks.see(k, pose, seen_from(pose, (places[order], turns[order], headings[order]), rng))
    assert len(landmarks.positions) == count
    np.testing.assert_array_equal(landmarks.counts, 10)
    assert len(sightings) == 10 * count


def test_a_landmark_ties_poses_once_it_is_proven_and_then_with_all_its_sightings() -> None:
    landmarks = LandmarkMap(LandmarkSettings(proven=3))
    worth = [landmarks.see(k, np.zeros(3), knot(1.0, 2.0)) for k in range(5)]
    assert [[sighting.pose for sighting in seen] for seen in worth] == [[], [], [0, 1, 2], [3], [4]]
    assert {sighting.landmark for seen in worth for sighting in seen} == {0}


def test_a_sighting_keeps_what_was_seen_in_the_robots_frame() -> None:
    landmarks = LandmarkMap(LandmarkSettings(proven=1))
    pose = np.array([3.0, 1.0, np.pi / 2])
    (sighting,) = landmarks.see(0, pose, knot(1.0, 0.0))
    np.testing.assert_array_equal(sighting.position, [1, 0])
    np.testing.assert_allclose(landmarks.positions, [[3, 2]])


@pytest.mark.parametrize(
    ("again", "same"),
    [
        (knot(1.05, 2.0), True),
        (knot(1.4, 2.0), False),
        (knot(1.0, 2.0, turn=-1.5), False),
        (knot(1.0, 2.0, heading=1.0), False),
        (knot(1.0, 2.0, heading=2 * np.pi - 0.1), True),
    ],
)
def test_what_is_near_and_alike_is_the_same_corner(again: Knots, same: bool) -> None:
    landmarks = LandmarkMap(SETTINGS)
    landmarks.see(0, np.zeros(3), knot(1.0, 2.0))
    landmarks.see(1, np.zeros(3), again)
    assert len(landmarks.positions) == (1 if same else 2)


def test_two_knots_of_one_scan_never_share_a_landmark() -> None:
    landmarks = LandmarkMap(SETTINGS)
    landmarks.see(0, np.zeros(3), knot(1.0, 2.0))
    both = Knots(
        np.array([[1.03, 2.0], [1.0, 2.0]]), np.full(2, 1.5), np.zeros(2), np.tile(np.eye(2) * 4e-4, (2, 1, 1))
    )
    landmarks.see(1, np.zeros(3), both)
    np.testing.assert_array_equal(landmarks.counts, [2, 1])
    np.testing.assert_allclose(landmarks.positions[1], [1.03, 2.0])


def test_a_knot_that_is_sure_only_along_one_direction_is_matched_along_the_other() -> None:
    """The covariance turns with the robot: 30 cm off along the doubtful axis is the same corner, across it is not."""
    pose = np.array([0.0, 0.0, np.pi / 2])
    doubtful_ahead = np.diag([0.2, 0.01])[None] ** 2
    for shift, count in (([0.3, 0.0], 1), ([0.0, 0.3], 2)):
        landmarks = LandmarkMap(SETTINGS)
        landmarks.see(0, pose, knot(2.0, 0.0))
        landmarks.see(1, pose, Knots(np.array([[2.0, 0.0]]) + shift, np.array([1.5]), np.zeros(1), doubtful_ahead))
        assert len(landmarks.positions) == count


def test_proven_landmarks_are_matched_where_they_are_now() -> None:
    landmarks = LandmarkMap(SETTINGS)
    landmarks.see(0, np.zeros(3), knot(1.0, 2.0))
    landmarks.settle(np.zeros((1, 3)), np.array([0]), np.array([[5.0, 5.0]]))
    landmarks.see(1, np.zeros(3), knot(5.0, 5.0))
    np.testing.assert_array_equal(landmarks.counts, [2])


def test_a_corner_seen_once_moves_and_turns_with_the_pose_that_saw_it() -> None:
    landmarks, moved = LandmarkMap(SETTINGS), np.array([4.0, -2.0, 1.0])
    landmarks.see(0, np.array([1.0, 1.0, 0.3]), knot(1.0, 2.0, heading=0.2))
    landmarks.settle(moved[None], np.empty(0, np.int64), np.empty((0, 2)))
    landmarks.see(1, moved, knot(1.0, 2.0, heading=0.2))
    np.testing.assert_array_equal(landmarks.counts, [2])
    np.testing.assert_allclose(landmarks.positions, transform(np.array([[1.0, 2.0]]), moved))


def test_a_scan_without_knots_changes_nothing() -> None:
    landmarks = LandmarkMap(SETTINGS)
    none = Knots(np.empty((0, 2)), np.empty(0), np.empty(0), np.empty((0, 2, 2)))
    assert landmarks.see(0, np.zeros(3), none) == []
    landmarks.see(1, np.zeros(3), knot(1.0, 2.0))
    assert landmarks.see(2, np.zeros(3), none) == []
    np.testing.assert_array_equal(landmarks.counts, [1])


def test_a_knot_that_may_be_anywhere_around_the_robot_is_no_landmark() -> None:
    landmarks = LandmarkMap(SETTINGS)
    landmarks.see(0, np.zeros(3), knot(0.01, 0.01))
    landmarks.see(0, np.zeros(3), knot(0.0, 0.0))
    assert len(landmarks.positions) == 0
