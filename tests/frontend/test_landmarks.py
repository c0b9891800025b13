from typing import Any

import numpy as np
import pytest

from frontend.landmarks import LandmarkSettings, chain_knots
from frontend.primitives import Primitive
from tests.frontend.test_scale_space import path

SETTINGS = LandmarkSettings()


def noisy(points: Any, noise: float, seed: int = 0) -> Any:
    return points + np.random.default_rng(seed).normal(0, noise, points.shape)


@pytest.mark.parametrize("turn", [0.8, np.pi / 2, -np.pi / 2, -1.2])
def test_a_corner_is_placed_where_its_walls_meet(turn: float) -> None:
    knots = chain_knots(noisy(path([(turn, 2.0)], 2.0, 0.05), 0.01), 0.01, SETTINGS)
    assert knots.kinds.tolist() == [Primitive.CORNER]
    assert np.allclose(knots.positions, [[2.0, 0.0]], atol=0.02)
    assert np.isclose(knots.turns[0], turn, atol=0.05)
    assert np.isclose(np.cos(knots.headings[0] - (np.pi / 2 + turn / 2)), 1.0, atol=0.01)


def test_the_covariance_says_how_far_off_the_corners_are() -> None:
    errors = []
    for seed in range(150):
        knots = chain_knots(noisy(path([(np.pi / 2, 2.0)], 2.0, 0.05), 0.01, seed), 0.01, SETTINGS)
        off = knots.positions[0] - [2.0, 0.0]
        errors.append(off @ np.linalg.inv(knots.covariances[0]) @ off)
    assert 1.0 < np.mean(errors) < 4.0


def test_noise_alone_makes_no_knots() -> None:
    wall = path([], 4.0, 0.03)
    shaken = [wall + [0, 1] * np.random.default_rng(seed).normal(0, 0.015, wall.shape) for seed in range(40)]
    assert sum(chain_knots(points, 0.015, SETTINGS).turns.size for points in shaken) <= 1


def test_a_box_against_the_wall_is_a_bump_of_four_corners() -> None:
    quarter = np.pi / 2
    points = path([(quarter, 0.4), (-quarter, 0.5), (-quarter, 0.4), (quarter, 2.0)], 2.0, 0.03)
    knots = chain_knots(noisy(points, 0.005), 0.005, SETTINGS)
    assert knots.kinds.tolist() == [Primitive.BUMP] * 4
    assert np.allclose(knots.positions, np.array([[2, 0], [2, 0.4], [2.5, 0.4], [2.5, 0]]), atol=0.03)


def test_a_chain_of_a_few_points_has_no_knots() -> None:
    assert not chain_knots(path([], 0.1, 0.05), 0.01, SETTINGS).turns.size


def test_a_niche_in_the_wall_is_a_dent_of_four_corners() -> None:
    quarter = np.pi / 2
    points = path([(-quarter, 0.4), (quarter, 0.5), (quarter, 0.4), (-quarter, 2.0)], 2.0, 0.03)
    knots = chain_knots(noisy(points, 0.005), 0.005, SETTINGS)
    assert knots.kinds.tolist() == [Primitive.DENT] * 4
    assert np.allclose(knots.positions, np.array([[2, 0], [2, -0.4], [2.5, -0.4], [2.5, 0]]), atol=0.03)


def test_the_end_of_a_screen_is_an_end_of_two_corners() -> None:
    quarter = np.pi / 2
    knots = chain_knots(noisy(path([(-quarter, 0.4), (-quarter, 2.0)], 2.0, 0.03), 0.005), 0.005, SETTINGS)
    assert knots.kinds.tolist() == [Primitive.END] * 2
    assert np.allclose(knots.positions, [[2.0, 0.0], [2.0, -0.4]], atol=0.03)


def test_a_wall_that_steps_aside_is_a_crank_of_two_corners() -> None:
    quarter = np.pi / 2
    knots = chain_knots(noisy(path([(quarter, 0.4), (-quarter, 2.0)], 2.0, 0.03), 0.005), 0.005, SETTINGS)
    assert knots.kinds.tolist() == [Primitive.CRANK] * 2
    assert np.allclose(knots.positions, [[2.0, 0.0], [2.0, 0.4]], atol=0.03)
    assert np.allclose(knots.turns, [quarter, -quarter], atol=0.1)
