from typing import Any

import numpy as np
import pytest

from frontend.scale_space import scale_space, track_paths, tracks

SIGMAS = 0.1 * np.sqrt(2.0) ** np.arange(5)


def path(turns: Any, length: float = 3.0, spacing: float = 0.02) -> Any:
    """Points along straight stretches with the turns between them."""
    headings = np.concatenate([[0.0], np.cumsum([turn for turn, _ in turns])])
    lengths = [length, *(stretch for _, stretch in turns)]
    points = [np.zeros(2)]
    for heading, stretch in zip(headings, lengths, strict=True):
        steps = np.arange(spacing, stretch + spacing / 2, spacing)
        points.extend(points[-1] + steps[:, None] * [np.cos(heading), np.sin(heading)])
    return np.array(points)


@pytest.mark.parametrize("turn", [0.3, np.pi / 4, np.pi / 2, -np.pi / 3])
def test_a_corner_reads_its_turn_at_every_scale(turn: float) -> None:
    space = scale_space(path([(turn, 3.0)]), SIGMAS, 0.02)
    peaks = space.turns[np.arange(5), np.argmax(np.abs(space.turns), axis=1)]
    # Half the finest sigma smooths places, not orientation, which sharpens a right angle by up to a tenth.
    assert np.allclose(peaks, turn, rtol=0.12)
    assert np.allclose(peaks[2:], turn, rtol=0.04)
    assert np.allclose(np.argmax(np.abs(space.turns), axis=1), 150, atol=2)


def test_a_straight_wall_turns_nowhere_not_even_at_its_ends() -> None:
    space = scale_space(path([]), SIGMAS, 0.02)
    assert np.max(np.abs(space.turns)) < 1e-9


def test_an_end_merges_at_coarse_scales_and_then_reads_both_turns() -> None:
    space = scale_space(path([(0.6, 0.2), (0.6, 3.0)]), np.array([0.05, 0.4]), 0.02)
    fine, coarse = space.turns
    assert np.sum((fine[1:-1] > fine[:-2]) & (fine[1:-1] >= fine[2:]) & (fine[1:-1] > 0.4)) == 2
    assert np.sum((coarse[1:-1] > coarse[:-2]) & (coarse[1:-1] >= coarse[2:]) & (coarse[1:-1] > 0.4)) == 1
    assert np.isclose(np.max(coarse), 1.2, rtol=0.08)


def test_a_crank_fades_with_the_square_of_the_scale() -> None:
    turn, riser = 0.5, 0.1
    space = scale_space(path([(turn, riser), (-turn, 3.0)]), np.array([0.05, 0.3, 0.5]), 0.01)
    for sigma, row in zip(space.sigmas[1:], space.turns[1:], strict=True):
        assert np.isclose(np.max(row), turn * riser / (sigma * np.sqrt(np.e)), rtol=0.1)


def test_what_lies_four_sigmas_away_changes_nothing() -> None:
    near, far = path([(0.5, 4.0)]), path([(0.5, 4.0), (1.0, 2.0)])
    a, b = scale_space(near, SIGMAS, 0.02), scale_space(far, SIGMAS, 0.02)
    inside = slice(0, int(5.0 / 0.02))
    assert np.allclose(a.turns[:, inside], b.turns[:, inside], atol=1e-6)


def test_a_corner_is_one_track_over_all_scales() -> None:
    space = scale_space(path([(0.8, 2.0), (-0.8, 2.0)]), SIGMAS, 0.02)
    found = tracks(space, np.full(5, 0.3))
    assert found.first.tolist() == [0, 0]
    assert found.last.tolist() == [4, 4]
    assert np.allclose(space.arc_length[found.place], [3.0, 5.0], atol=0.04)


def test_a_corners_track_runs_through_every_scale_without_moving() -> None:
    walls = np.vstack([np.column_stack([np.linspace(0, 3, 61), np.zeros(61)]),
                       np.column_stack([np.full(60, 3.0), np.linspace(0.05, 3, 60)])])  # fmt: skip
    space = scale_space(walls, 0.1 * np.sqrt(2.0) ** np.arange(5), 0.04)
    (path,) = track_paths(space, np.full(5, 0.4))
    assert path[:, 0].tolist() == [0, 1, 2, 3, 4]
    assert np.allclose(space.arc_length[path[:, 1]], 3.0, atol=0.05)


@pytest.mark.parametrize("radius", [0.8, 1.5])
def test_where_straight_meets_curved_the_second_derivative_peaks_at_the_step_of_curvature(radius: float) -> None:
    arc = np.arange(0.01, np.pi / 2, 0.01 / radius)
    bend = np.column_stack([3.0 + radius * np.sin(arc), radius * (1 - np.cos(arc))])
    wall = np.vstack([np.column_stack([np.arange(0, 3.0, 0.01), np.zeros(300)]), bend])
    space = scale_space(wall, np.array([0.1, 0.2]), 0.01)
    for sigma, turns in zip(space.sigmas, space.turns, strict=True):
        second = np.gradient(turns / (sigma * np.sqrt(2 * np.pi)), space.arc_length)  # (G∗θ)″
        near = np.abs(space.arc_length - 3.0) < 2 * sigma
        assert np.isclose(np.max(second[near]), 1 / (radius * sigma * np.sqrt(2 * np.pi)), rtol=0.06)
        assert np.isclose(space.arc_length[near][np.argmax(second[near])], 3.0, atol=0.04)
        assert np.min(second[near]) > -0.1 * np.max(second[near])  # a corner would have an opposite partner


def test_a_bump_is_gone_at_coarse_scale() -> None:
    quarter = np.pi / 2
    bump = path([(quarter, 0.1), (-quarter, 0.2), (-quarter, 0.1), (quarter, 3.0)], spacing=0.01)
    fine, coarse = scale_space(bump, np.array([0.02, 0.8]), 0.01).turns
    assert np.max(np.abs(fine)) > 1.3
    assert np.max(np.abs(coarse)) < 0.15


@pytest.mark.parametrize("level", [1, 2, 3])
def test_noise_turns_a_straight_wall_as_much_as_the_noise_law_says(level: int) -> None:
    noise, spacing = 0.004, 0.04
    wall = np.column_stack([np.arange(0.0, 40.0, spacing), np.zeros(1000)])
    shaken = wall + np.random.default_rng(0).normal(0.0, noise, (1000, 1)) * np.array([0.0, 1.0])
    turns = scale_space(shaken, SIGMAS, spacing).turns[level, 50:-50]
    law = noise * np.sqrt(2 * np.pi) * np.sqrt(3 * spacing / (8 * np.sqrt(np.pi))) * SIGMAS[level] ** -1.5
    assert np.isclose(np.std(turns), law, rtol=0.15)
