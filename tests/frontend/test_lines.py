import numpy as np

from frontend.lines import crossing, fit_line


def test_a_fitted_line_runs_in_the_order_of_its_points() -> None:
    points = np.column_stack([np.linspace(3, 0, 20), np.full(20, 1.0)])
    line = fit_line(points, 0, 20, 0.01)
    assert np.allclose(line[:2], [1.5, 1.0])
    assert np.isclose(np.cos(line[2]), -1.0)


def test_the_variances_are_those_of_many_noisy_lines() -> None:
    rng = np.random.default_rng(0)
    clean = np.column_stack([np.linspace(-1, 1, 30), np.zeros(30)])
    fits = np.array([fit_line(clean + rng.normal(0, 0.02, clean.shape), 0, 30, 0.02) for _ in range(400)])
    assert np.isclose(np.var(fits[:, 1]), np.mean(fits[:, 3]), rtol=0.3)
    assert np.isclose(np.var(fits[:, 2]), np.mean(fits[:, 4]), rtol=0.3)


def test_two_walls_meet_at_their_corner_and_parallel_ones_nowhere() -> None:
    level = np.array([1.0, 2.0, 0.0, 1e-4, 1e-5, 0.0])
    upright = np.array([3.0, 0.0, np.pi / 2, 4e-4, 1e-5, 0.0])
    meet = crossing(level, upright)
    assert np.allclose(meet[:2], [3.0, 2.0])
    assert meet[2] > meet[4] > 0
    assert np.isnan(crossing(level, level)).all()
