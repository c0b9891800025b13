"""Claims about views coupled by the lines they share."""

import numpy as np

from backend.cell_lines import CellGrid, cell_lines
from backend.samples import Samples
from backend.shared_lines import normal_equations, solved


def two_views(shift: float) -> Samples:
    """Two views of a wall along x, the second of them `shift` metres too high."""
    x = np.tile(np.linspace(0.05, 0.95, 19), 2)
    view = np.repeat([0, 1], 19)
    points = np.column_stack([x, 0.3 + shift * view])
    normals, ones = np.tile([0.0, 1.0], (38, 1)), np.ones(38)
    return Samples(points, normals, view, 0.02 * ones, ones, ones.astype(bool))


def test_two_views_of_one_wall_meet_halfway() -> None:
    placed, poses, prior = two_views(0.02), np.zeros((2, 3)), np.diag([1.0, 1.0, 1e3])
    lines = cell_lines(placed.points, placed.normals, placed.weight, placed.weight, CellGrid(1.0, np.zeros(2), 0.1))
    blocks, gradient, shared = normal_equations(placed, placed.weight * 1e4, lines, poses)
    steps = solved(blocks + prior, shared, -gradient)
    np.testing.assert_allclose(steps[:, 1], [0.01, -0.01], atol=1e-4)


def test_all_views_of_a_wall_move_freely_together() -> None:
    placed, poses = two_views(0.0), np.zeros((2, 3))
    lines = cell_lines(placed.points, placed.normals, placed.weight, placed.weight, CellGrid(1.0, np.zeros(2), 0.1))
    blocks, _, shared = normal_equations(placed, placed.weight * 1e4, lines, poses)
    prior = np.diag([1.0, 1.0, 1e3])
    pulled = solved(blocks + prior, shared, np.array([[0.0, 1.0, 0.0], [0.0, 1.0, 0.0]]))
    np.testing.assert_allclose(pulled[:, 1], [1.0, 1.0], atol=1e-3)


def test_what_one_view_alone_measured_binds_nobody() -> None:
    placed = two_views(0.0)
    alone = placed.where(placed.view == 0)
    lines = cell_lines(alone.points, alone.normals, alone.weight, alone.weight, CellGrid(1.0, np.zeros(2), 0.1))
    blocks, gradient, shared = normal_equations(alone, alone.weight, lines, np.zeros((1, 3)))
    assert not blocks.any()
    assert not gradient.any()
    assert len(shared.view) == 0
