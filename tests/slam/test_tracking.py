"""Tracking: a scan is placed by registration where it can be, by the wheels where it cannot, and says which."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import chi2

from backend.odometry import Move
from frontend.local_map import Faces
from frontend.rigid_motion import between, compose
from frontend.scan import Floats, Scan
from frontend.sensors.lidar import LIDAR
from slam.perception import FrontendSettings, Percept, perceive
from slam.simulation.record import lidar_scan
from slam.tracking import Placed, TrackingSettings, track, turned
from tests.simulated_drives import BEARINGS, corridor, faces_from, furnished_room, surface_at

SETTINGS = TrackingSettings()
WHEELS = np.diag([0.03, 0.03, 0.03]) ** 2
LAST = np.array([2.3, 2.4, 0.2])
TRUE_MOVE = np.array([0.3, 0.05, 0.2])
NOWHERE = Faces(np.empty((0, 2)), np.empty((0, 2)))


def percept_of(ranges: Floats) -> Percept:
    return perceive(Scan(BEARINGS, ranges, LIDAR, np.zeros(3), 0.0), FrontendSettings())


def placed_after(claimed: Floats, seed: int = 0, views: int = 4) -> tuple[Placed, Floats]:
    """Where the scan after the true move is put when the wheels claim another one; and its error (3,), own axes."""
    rng = np.random.default_rng(seed)
    world = furnished_room(rng)
    true = compose(LAST, TRUE_MOVE)
    poses = [compose(LAST, np.array([-0.1 * k, 0, 0])) for k in range(views)]
    percept = percept_of(lidar_scan(world, true, LIDAR, rng))
    placed = track(percept, LAST, Move(claimed, WHEELS), [faces_from(world, [pose], rng) for pose in poses], SETTINGS)
    return placed, between(true, placed.pose)


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 2**32 - 1), st.floats(-3, 3))
def test_turning_a_covariance_keeps_its_size_and_is_undone_by_turning_back(seed: int, angle: float) -> None:
    root = np.random.default_rng(seed).normal(size=(3, 3))
    covariance = root @ root.T
    there = turned(covariance, angle)
    np.testing.assert_allclose(np.linalg.eigvalsh(there[:2, :2]), np.linalg.eigvalsh(covariance[:2, :2]), atol=1e-9)
    assert there[2, 2] == pytest.approx(covariance[2, 2])
    np.testing.assert_allclose(turned(there, -angle), covariance, atol=1e-9)


def test_a_quarter_turn_swaps_the_axes() -> None:
    np.testing.assert_allclose(turned(np.diag([4.0, 1.0, 9.0]), np.pi / 2), np.diag([1.0, 4.0, 9.0]), atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_a_scan_is_placed_to_a_centimetre_where_the_wheels_err_by_five(seed: int) -> None:
    placed, error = placed_after(TRUE_MOVE + np.array([0.05, -0.03, 0.04]), seed)
    assert placed.refused is None
    assert placed.matched > 0.8
    assert np.hypot(*error[:2]) < 0.01
    assert abs(error[2]) < 0.004


def test_the_covariance_of_a_placed_scan_is_not_too_small() -> None:
    squares = []
    for seed in range(25):
        placed, error = placed_after(TRUE_MOVE, seed)
        squares.append(error @ np.linalg.solve(placed.covariance, error))
    assert np.sum(squares) < chi2.ppf(0.999, 3 * len(squares))


def test_a_wider_search_finds_what_the_wheels_lost() -> None:
    """The wheels err by 35 cm and 12°, twelve of their own sigmas: more than registration alone can bridge."""
    placed, error = placed_after(TRUE_MOVE + np.array([-0.25, 0.25, 0.2]))
    assert placed.refused is None
    assert np.hypot(*error[:2]) < 0.03


def test_a_scan_of_another_room_is_left_to_the_wheels_with_the_reason() -> None:
    rng = np.random.default_rng(3)
    faces = faces_from(furnished_room(rng), [LAST], rng)
    elsewhere = percept_of(lidar_scan(corridor(), np.array([30.0, 1.0, 0.5]), LIDAR, rng))
    placed = track(elsewhere, LAST, Move(TRUE_MOVE, WHEELS), [faces], SETTINGS)
    assert placed.refused is not None
    assert "% of" in placed.refused
    assert placed.matched < SETTINGS.poor
    np.testing.assert_allclose(placed.pose, compose(LAST, TRUE_MOVE))


@pytest.mark.parametrize("silence", [np.inf, np.nan])
def test_a_blind_scan_is_left_to_the_wheels_with_the_reason(silence: float) -> None:
    rng = np.random.default_rng(4)
    faces = faces_from(furnished_room(rng), [LAST], rng)
    placed = track(percept_of(np.full(360, silence)), LAST, Move(TRUE_MOVE, WHEELS), [faces], SETTINGS)
    assert placed.refused is not None
    assert "0 surface points" in placed.refused
    np.testing.assert_allclose(placed.pose, compose(LAST, TRUE_MOVE))


@pytest.mark.parametrize("recent", [[], [NOWHERE]])
def test_without_a_map_the_wheels_decide(recent: list[Faces]) -> None:
    rng = np.random.default_rng(5)
    world = furnished_room(rng)
    percept = percept_of(lidar_scan(world, LAST, LIDAR, rng))
    placed = track(percept, LAST, Move(TRUE_MOVE, WHEELS), recent, SETTINGS)
    assert placed.refused is not None
    assert "too few to register" in placed.refused
    np.testing.assert_allclose(placed.pose, compose(LAST, TRUE_MOVE))


def test_the_doubt_of_the_wheels_is_carried_in_the_axes_of_the_new_pose() -> None:
    """Left alone, doubt ahead of a move that ends in a quarter turn is doubt to its right side."""
    ahead = Move(np.array([1.0, 0.0, np.pi / 2]), np.diag([0.2, 0.01, 0.02]) ** 2)
    placed = track(percept_of(np.full(360, np.inf)), LAST, ahead, [NOWHERE], SETTINGS)
    np.testing.assert_allclose(placed.covariance, np.diag([0.01, 0.2, 0.02]) ** 2, atol=1e-12)


def test_in_a_corridor_the_wheels_say_how_far_and_the_walls_say_the_rest() -> None:
    rng = np.random.default_rng(6)
    last, move = np.array([30.0, 1.0, 0.0]), np.array([0.3, 0.0, 0.0])
    percept = percept_of(lidar_scan(corridor(), compose(last, move), LIDAR, rng))
    claimed = Move(move + np.array([0.01, 0.04, 0.03]), WHEELS)
    placed = track(percept, last, claimed, [faces_from(corridor(), [last], rng)], SETTINGS)
    assert placed.refused is None
    assert abs(placed.pose[0] - 30.31) < 0.03
    assert abs(placed.pose[1] - 1.0) < 0.01
    assert np.sqrt(placed.covariance[0, 0]) > 0.01
    assert np.sqrt(placed.covariance[1, 1]) < 0.005


def test_the_faces_of_the_other_side_of_a_wall_are_not_used() -> None:
    rng = np.random.default_rng(7)
    world = furnished_room(rng)
    seen = faces_from(world, [LAST], rng)
    behind = replace(seen, normals=-seen.normals)
    percept = percept_of(lidar_scan(world, LAST, LIDAR, rng))
    placed = track(percept, LAST, Move(np.zeros(3), WHEELS), [behind], SETTINGS)
    assert placed.matched < 0.1
    assert len(surface_at(world, LAST, rng).points) > 300
