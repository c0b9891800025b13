"""Claims about samples of many views."""

import numpy as np

from backend.samples import Samples
from tests.backend.placed_samples import joined, wall_samples


def test_placing_moves_points_and_only_turns_normals() -> None:
    samples = wall_samples(np.zeros(2), np.array([1.0, 0.0]), 2, 0.0, np.random.default_rng(0))
    placed = samples.placed(np.array([[1.0, 2.0, np.pi / 2], [0.0, 0.0, 0.0]]))
    first = placed.where(placed.view == 0)
    np.testing.assert_allclose(first.points[:, 0], 1.0, atol=1e-12)
    np.testing.assert_allclose(first.normals, np.tile([-1.0, 0.0], (len(first.view), 1)), atol=1e-12)
    np.testing.assert_allclose(placed.points[placed.view == 1], samples.points[samples.view == 1])


def test_choosing_keeps_all_fields_in_step() -> None:
    rng = np.random.default_rng(1)
    two = joined(*(wall_samples(np.zeros(2), np.array([x, 0.0]), 1, 0.01, rng) for x in (1.0, 2.0)))
    far = two.where(two.points[:, 0] > 1.0)
    assert len(far.view) == len(far.points) == len(far.normals) == len(far.sigma) == len(far.weight) == len(far.sure)
    assert far.points[:, 0].min() > 1.0


def test_thinning_keeps_the_weight_and_does_not_depend_on_other_views() -> None:
    rng = np.random.default_rng(2)
    one, other = (wall_samples(np.zeros(2), np.array([x, 0.0]), 1, 0.01, rng) for x in (2.03, 3.0))
    thin = joined(one, other).thinned(0.2)
    assert len(thin.view) < 0.3 * (len(one.view) + len(other.view))
    np.testing.assert_allclose(thin.weight.sum(), one.weight.sum() + other.weight.sum(), atol=0.4)
    np.testing.assert_array_equal(one.thinned(0.2).points, thin.points[: len(one.thinned(0.2).points)])


def test_samples_about_a_point_are_all_that_lie_within_a_cell_of_it() -> None:
    rng = np.random.default_rng(3)
    points, ones = rng.uniform(-2, 2, (500, 2)), np.ones(500)
    samples = Samples(points, points, ones.astype(int), ones, ones, ones.astype(bool))
    about = samples.about(np.array([[0.3, -0.4]]), 0.2)
    away = np.abs(points - [0.3, -0.4]).max(axis=1)
    assert about[away < 0.2].all()
    assert not about[away > 0.4].any()
    assert not samples.about(np.empty((0, 2)), 0.2).any()
