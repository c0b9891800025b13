"""Long faces: noise takes the direction of its wall, and what truly turns keeps its own."""

import numpy as np
import pytest

from backend.face_cells import Floats, Lines
from backend.long_faces import Straightness, straightened

RULES = Straightness(stretch=4, sectors=12, thickest=0.04, sigmas=3.0, shared=7)
SQUARES = np.column_stack([np.arange(4), np.zeros(4, np.int64), np.zeros(4, np.int64)])


def row(angles: Floats, scatter: float = 0.01) -> Lines:
    """Four cells of half a metre along the x axis, whose lines are turned by angles (4,)."""
    centres = np.column_stack([0.25 + 0.5 * np.arange(4), np.zeros(4)])
    normals = np.column_stack([-np.sin(angles), np.cos(angles)])
    return Lines(centres, normals, np.ones(4, np.bool_), np.full(4, scatter**2), np.full(4, 0.02), np.full(4, 60.0))


def turns(lines: Lines) -> Floats:
    return np.asarray(np.arctan2(-lines.normals[:, 0], lines.normals[:, 1]))


def test_noisy_directions_become_that_of_their_wall() -> None:
    noisy = np.array([0.02, -0.01, -0.02, 0.015])
    assert np.max(np.abs(turns(straightened(row(noisy), SQUARES, RULES)))) < 0.004


def test_a_cell_that_surely_turns_keeps_its_direction() -> None:
    angles = np.array([0.0, 0.0, 0.0, 0.3])
    found = turns(straightened(row(angles, scatter=0.003), SQUARES, RULES))
    assert found[3] == pytest.approx(0.3)


def test_pieces_on_either_side_of_a_border_know_nothing_of_each_other() -> None:
    roof = row(np.array([0.02, 0.02, -0.02, -0.02]))
    roof.centres[:, 1] = [0.0, 0.01, 0.01, 0.0]
    found = turns(straightened(roof, SQUARES + np.array([2, 0, 0]), RULES))
    np.testing.assert_allclose(found, [0.02, 0.02, -0.02, -0.02], atol=1e-3)


def test_normals_that_point_the_other_way_stay_on_their_side() -> None:
    lines = row(np.array([0.01, np.pi - 0.01, 0.01, np.pi]))
    found = straightened(lines, SQUARES, RULES)
    assert np.all(np.sum(found.normals * lines.normals, axis=1) > 0.99)


def test_without_lines_there_is_nothing_to_do() -> None:
    lines = Lines(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0, np.bool_), *np.zeros((3, 0)))
    assert straightened(lines, np.zeros((0, 3), np.int64), RULES) is lines
