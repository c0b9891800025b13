"""Correlative search: branch and bound finds what trying every pose of the window finds."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from frontend.correlative_search import ScoreGrid, SearchSettings
from frontend.rigid_motion import compose, inverse, transform
from frontend.scan import Floats
from tests.simulated_drives import furnished_room, surface_at

COARSE = SearchSettings(cell=0.1, blur=0.12, levels=3)


def score_at(points: Floats, map_points: Floats, pose: Floats, search: SearchSettings) -> float:
    """How near the points come to the map, without any grid over the poses."""
    placed = transform(points, pose)
    gaps = np.linalg.norm(placed[:, None] - map_points[None], axis=2).min(axis=1)
    return float(np.mean(np.exp(-(gaps**2) / (2 * search.blur**2))))


def by_brute_force(points: Floats, map_points: Floats, guess: Floats, window: tuple[float, float]) -> float:
    """The best score over every shift in cells and every turn of the window, each asked for alone."""
    grid = ScoreGrid.of(map_points, replace(COARSE, levels=1))
    step = COARSE.cell / max(float(np.linalg.norm(points, axis=1).max()), 1.0)
    most, span = int(np.ceil(window[1] / step)), int(np.ceil(window[0] / COARSE.cell))
    shifts = product(range(-span, span + 1), range(-span, span + 1), range(-most, most + 1))
    steps = np.array([COARSE.cell, COARSE.cell, step])
    alone = (grid.search(points, guess + steps * shift, (0.0, 0.0), 0.0) for shift in shifts)
    return max((found.score for found in alone if found is not None), default=0.0)


@settings(deadline=None, max_examples=12)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 2, 3]), st.floats(0.0, 0.2))
def test_branch_and_bound_misses_no_pose_that_brute_force_finds(seed: int, levels: int, radians: float) -> None:
    rng = np.random.default_rng(seed)
    map_points, points = rng.uniform(-2, 2, (60, 2)), rng.uniform(-1.5, 1.5, (25, 2))
    guess, metres = rng.uniform(-0.3, 0.3, 3), float(rng.uniform(0.1, 0.45))
    found = ScoreGrid.of(map_points, replace(COARSE, levels=levels)).search(points, guess, (metres, radians), 0.0)
    assert found is not None
    assert found.score > by_brute_force(points, map_points, guess, (metres, radians)) - 1e-4
    # What it claims of the pose it found is what that pose scores when asked for alone.
    assert found.score == pytest.approx(by_brute_force(points, map_points, found.pose, (0.0, 0.0)), abs=0.02)


@pytest.mark.parametrize("seed", range(8))
def test_a_scan_is_found_from_half_a_metre_and_14_degrees_off(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world = furnished_room(rng)
    centre = np.array([*world.free.centroid.coords[0], rng.uniform(-3, 3)])
    true = compose(centre, rng.uniform(-1, 1, 3) * [0.3, 0.3, 1.0])
    grid = ScoreGrid.of(transform(surface_at(world, centre, rng).points, centre), SearchSettings())
    off = compose(true, rng.uniform(-1, 1, 3) * [0.35, 0.35, 0.24])
    found = grid.search(surface_at(world, true, rng).points, off, (0.5, 0.25), 0.3)
    assert found is not None
    error = compose(inverse(true), found.pose)
    assert np.hypot(*error[:2]) < 0.1
    assert abs(error[2]) < 0.05


def test_the_score_is_that_of_the_pose_it_stands_for() -> None:
    rng = np.random.default_rng(3)
    walls = np.concatenate([np.linspace((0, 0), (4, 0), 200), np.linspace((0, 0), (0, 3), 150)])
    points = transform(walls[::5], inverse(np.array([1.0, 1.0, 0.2]))) + rng.normal(0, 0.01, (70, 2))
    search = SearchSettings()
    found = ScoreGrid.of(walls, search).search(points, np.array([1.1, 0.9, 0.15]), (0.3, 0.1), 0.2)
    assert found is not None
    assert found.score == pytest.approx(score_at(points, walls, found.pose, search), abs=0.1)
    assert found.score > 0.85


def test_nothing_is_found_where_no_pose_scores_enough() -> None:
    rng = np.random.default_rng(4)
    grid = ScoreGrid.of(rng.uniform(-2, 2, (10, 2)), COARSE)
    assert grid.search(rng.uniform(-2, 2, (40, 2)), np.zeros(3), (0.5, 0.2), 0.95) is None
    assert grid.search(rng.uniform(-2, 2, (40, 2)), np.array([50.0, 50, 0]), (0.5, 0.2), 0.01) is None


def test_no_pose_outside_the_window_is_ever_returned() -> None:
    """The true place is a metre away, the window 40 cm: what is found may be poor, but lies in the window."""
    walls = np.concatenate([np.linspace((0, 0), (5, 0), 200), np.linspace((0, 0), (0, 5), 200)])
    search = SearchSettings()
    grid = ScoreGrid.of(walls, search)
    for aside in ([1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]):
        found = grid.search(walls - aside, np.zeros(3), (0.4, 0.0), 0.1)
        assert found is not None
        assert np.max(np.abs(found.pose[:2])) <= 0.4 + search.cell / 2
