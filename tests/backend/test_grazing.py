"""Claims about grazing sight: what a smooth wall mirrors is no free ground."""

import numpy as np
from numpy.typing import NDArray

from backend.grazing import GrazingSettings, Walls, up_to_mirrors, walls_of
from backend.samples import Samples
from backend.wall_faces import FaceSettings, fuse_faces

# A wall along y = 0, measured from x = 0 to 2, free above.
ASLANT = np.array([[-1.0, 1.0], [4.5, -0.7], [4.5, 2.0], [-1.0, 2.0]])
LEFT = np.array([0.5, 1.0])
View = tuple[NDArray[np.float64], NDArray[np.float64]]


def walls_by(*views: View) -> Walls:
    """The face of the wall, as two views measured it from above, and what all views say of it."""
    x = np.tile(np.linspace(0, 2, 41), 2)
    points = np.column_stack([x, np.zeros_like(x)])
    ones, view = np.ones_like(x), np.repeat([0, 1], 41)
    samples = Samples(points, np.tile([0.0, 1.0], (82, 1)), view, 0.01 * ones, 0.05 * ones, ones > 0)
    faces, seen = fuse_faces(samples, FaceSettings()), (views * 2)[: max(2, len(views))]
    return walls_of(
        faces, samples, [ring for ring, _ in seen], np.array([origin for _, origin in seen]), GrazingSettings()
    )


def test_a_beam_that_grazes_the_line_of_a_wall_ends_there() -> None:
    near, far = up_to_mirrors(ASLANT, ASLANT, LEFT, walls_by((ASLANT, LEFT)))
    np.testing.assert_allclose(near[1], [0.5 + 4 / 1.7, 0.0], atol=0.01)
    np.testing.assert_array_equal(near[[0, 2, 3]], ASLANT[[0, 2, 3]])
    np.testing.assert_array_equal(near, far)


def test_where_another_view_looks_through_squarely_there_is_an_opening() -> None:
    through = np.array([[2.2, 0.9], [2.3, -1.0], [3.4, -1.0], [3.8, 0.9], [3.0, 1.5]])
    walls = walls_by((ASLANT, LEFT), (through, np.array([3.0, 1.0])))
    near, _ = up_to_mirrors(ASLANT, ASLANT, LEFT, walls)
    np.testing.assert_array_equal(near, ASLANT)


def test_a_wall_says_nothing_farther_off_than_it_is_long() -> None:
    ring = np.array([[-1.0, 1.0], [9.0, -0.5], [9.0, 2.0], [-1.0, 2.0]])
    near, _ = up_to_mirrors(ring, ring, LEFT, walls_by((ring, LEFT)))
    np.testing.assert_array_equal(near, ring)


def test_the_surely_free_ring_stays_where_only_its_bound_lies_behind_the_wall() -> None:
    sure = np.array([[-1.0, 1.0], [2.1, 0.2], [4.5, 2.0], [-1.0, 2.0]])
    near, far = up_to_mirrors(sure, ASLANT, LEFT, walls_by((ASLANT, LEFT)))
    np.testing.assert_array_equal(near, sure)
    np.testing.assert_allclose(far[1], [0.5 + 4 / 1.7, 0.0], atol=0.01)


def test_a_wall_seen_through_where_it_was_measured_is_a_mirror_and_answers_no_more_aslant() -> None:
    bearings = np.linspace(-0.9, -0.4, 30)
    mirrored = LEFT + 4.0 * np.column_stack([np.cos(bearings), np.sin(bearings)])
    ring = np.vstack([mirrored, [[4.5, 2.0], [-3.0, 2.0], [-3.0, 0.5], [0.4, 0.01]]])
    overhead = (np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 3.0]]), np.array([1.0, 2.5]))
    near, _ = up_to_mirrors(ring, ring, LEFT, walls_by(overhead, overhead, (ring, LEFT)))
    assert near[:30, 1].min() > -0.01
    rough, _ = up_to_mirrors(ring, ring, LEFT, walls_by(overhead))
    assert rough[:30, 1].min() < -1.0
