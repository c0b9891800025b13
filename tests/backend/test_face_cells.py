"""Face cells: what shares a line, what does not, and which lines are believed."""

import numpy as np
import pytest

from backend.face_cells import LineRules, Sheaf, into_cells, lines_of

RULES = LineRules(views=3, width=0.03, thickest=0.04, cosine=0.9)
SHIFT = np.zeros(2)


def wall(views: int, offsets: np.ndarray, normal: tuple[float, float] = (0.0, 1.0)) -> Sheaf:
    """Every view, all at the origin, sees the same points of a wall at y = 0.1, moved by offsets across it."""
    x = np.linspace(0.02, 0.48, len(offsets))
    points = np.column_stack([x, 0.1 + offsets])
    count = views * len(x)
    return Sheaf(
        np.tile(points, (views, 1)), np.tile(normal, (count, 1)), np.full(count, 0.01), np.arange(count) // len(x)
    )


def test_points_are_placed_where_their_pose_stands() -> None:
    sheaf = Sheaf(np.array([[1.0, 0.0]]), np.array([[-1.0, 0.0]]), np.array([0.01]), np.array([1]))
    cells = into_cells(sheaf, np.array([[0.0, 0.0, 0.0], [2.0, 3.0, np.pi / 2]]), 0.5, SHIFT, 12)
    np.testing.assert_allclose(cells.points, [[2.0, 4.0]])
    np.testing.assert_allclose(cells.normals, [[0.0, -1.0]], atol=1e-12)


def test_the_two_faces_of_a_thin_wall_share_no_cell() -> None:
    near, far = wall(1, np.zeros(5)), wall(1, np.zeros(5), normal=(0.0, -1.0))
    both = Sheaf(
        np.concatenate([near.points, far.points]),
        np.concatenate([near.normals, far.normals]),
        np.concatenate([near.spread, far.spread]),
        np.zeros(10, np.int64),
    )
    cells = into_cells(both, np.zeros((1, 3)), 0.5, SHIFT, 12)
    assert np.diff(cells.starts).tolist() == [5, 5]


@pytest.mark.parametrize(("views", "kept"), [(2, False), (3, True)])
def test_a_line_needs_enough_views(views: int, kept: bool) -> None:
    lines = lines_of(into_cells(wall(views, np.zeros(8)), np.zeros((views, 3)), 0.5, SHIFT, 12), RULES)
    assert lines.kept.tolist() == [kept]


def test_a_few_points_off_the_wall_do_not_move_its_line() -> None:
    offsets = np.zeros(20)
    offsets[[3, 11]] = 0.15
    lines = lines_of(into_cells(wall(4, offsets), np.zeros((4, 3)), 0.5, SHIFT, 12), RULES)
    height = lines.centres[0, 1] + lines.normals[0, 0] / lines.normals[0, 1] * (lines.centres[0, 0] - 0.25)
    assert height == pytest.approx(0.1, abs=0.003)


def test_what_lies_as_deep_as_it_is_wide_is_no_line() -> None:
    offsets = np.tile([0.0, 0.3], 10)
    assert not lines_of(into_cells(wall(4, offsets), np.zeros((4, 3)), 0.5, SHIFT, 12), RULES).kept.any()


def test_a_line_that_runs_towards_its_own_viewers_is_none() -> None:
    lines = lines_of(into_cells(wall(4, np.zeros(8), (1.0, 0.0)), np.zeros((4, 3)), 0.5, SHIFT, 12), RULES)
    assert not lines.kept.any()
