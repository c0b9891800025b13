"""Claims about lines in cells."""

import numpy as np

from backend.cell_lines import CellGrid, cell_lines, distinct_views


def test_a_minority_on_a_parallel_surface_does_not_pull_the_line() -> None:
    x = np.linspace(0.02, 0.48, 40)
    points = np.column_stack([x, np.where(np.arange(40) % 4 == 0, 0.3, 0.2)])
    normals = np.tile([0.0, 1.0], (40, 1))
    lines = cell_lines(points, normals, np.ones(40), np.full(40, 0.02), CellGrid(0.5, np.zeros(2), 0.1))
    assert len(lines.keys) == 1
    assert abs(lines.centres[0, 1] - 0.2) < 0.006
    assert lines.trust[points[:, 1] > 0.25].max() < 0.1


def test_opposite_facing_samples_of_one_cell_are_two_lines() -> None:
    points = np.tile([[0.2, 0.2]], (6, 1))
    normals = np.array([[0.0, 1.0]] * 3 + [[0.0, -1.0]] * 3)
    lines = cell_lines(points, normals, np.ones(6), np.ones(6), CellGrid(0.5, np.zeros(2), 0.1))
    assert len(lines.keys) == 2
    assert set(lines.group[:3]).isdisjoint(lines.group[3:])


def test_a_view_counts_once_per_group() -> None:
    assert distinct_views(np.array([0, 0, 0, 1]), np.array([5, 5, 2, 5]), 3).tolist() == [2, 1, 0]
