from typing import Any

import numpy as np
import pytest

from frontend.surface import line_fits

ORIGIN = np.zeros(2)


def chain(points: Any) -> Any:
    joined = np.ones(len(points), dtype=bool)
    joined[-1] = False
    return np.asarray(points, dtype=float), joined


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0, -2.5])
def test_a_wall_has_one_normal_towards_the_sensor(angle: float) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    points, joined = chain(np.column_stack([np.full(20, 2.0), np.linspace(-1, 1, 20)]) @ turn.T)
    normals, thickness, _ = line_fits(points, joined, np.full(20, 3), ORIGIN)
    assert np.allclose(normals, -turn[:, 0])
    assert np.allclose(thickness, 0.0, atol=1e-7)


def test_a_corner_keeps_the_normals_of_both_its_walls() -> None:
    along = np.linspace(0, 1, 11)
    points, joined = chain(
        np.vstack([np.column_stack([np.full(11, 2.0), along]), np.column_stack([2 - along[1:], np.ones(10)])])
    )
    normals, _, _ = line_fits(points, joined, np.full(21, 3), ORIGIN)
    assert np.allclose(np.max(np.abs(normals), axis=1), 1.0, atol=1e-6)


def test_two_points_make_no_surface() -> None:
    points, joined = chain([[1.0, 0.0], [1.0, 0.1]])
    normals, thickness, _ = line_fits(points, joined, np.full(2, 3), ORIGIN)
    assert np.isnan(normals).all()
    assert np.isnan(thickness).all()


def test_points_on_their_line_fits_lie_nearer_to_the_wall_than_the_readings() -> None:
    rng = np.random.default_rng(0)
    noisy = np.column_stack([2 + rng.normal(0, 0.01, 200), np.linspace(-2, 2, 200)])
    points, joined = chain(noisy)
    normals, _, offset = line_fits(points, joined, np.full(200, 3), ORIGIN)
    drawn = points + normals * offset[:, None]
    assert np.std(drawn[5:-5, 0]) < 0.9 * np.std(noisy[5:-5, 0])
