"""Claims about fused faces."""

import numpy as np

from backend.wall_faces import FaceSettings, fuse_faces
from tests.backend.placed_samples import joined, wall_samples

A, B, UP = np.array([0.0, 0.0]), np.array([3.0, 0.0]), np.array([0.0, 1.0])


def test_views_that_scatter_about_a_wall_share_one_face_at_their_mean() -> None:
    samples = wall_samples(A, B, 12, 0.01, np.random.default_rng(0))
    faces = fuse_faces(samples, FaceSettings())
    best = int(np.argmax(faces.support))
    assert faces.support[best] == 12
    assert abs(faces.centres[best] @ faces.normals[best]) < 0.006
    np.testing.assert_allclose(faces.normals[best], [0, 1], atol=0.01)
    assert faces.spans[best, 1] - faces.spans[best, 0] > 2.8


def test_the_two_sides_of_a_thin_wall_stay_two_faces() -> None:
    rng = np.random.default_rng(1)
    upper = wall_samples(A + 0.04 * UP, B + 0.04 * UP, 6, 0.005, rng)
    lower = wall_samples(B, A, 6, 0.005, rng)
    faces = fuse_faces(joined(upper, lower), FaceSettings())
    label = faces.label
    assert set(label[: len(upper.view)]).isdisjoint(label[len(upper.view) :])
    above = faces.nearest(np.array([[1.5, 0.05]]), np.array([[0.0, 1.0]]), 0.06)
    below = faces.nearest(np.array([[1.5, 0.01]]), np.array([[0.0, -1.0]]), 0.06)
    assert faces.normals[above[0], 1] > 0 > faces.normals[below[0], 1]


def test_walls_that_meet_at_a_corner_are_two_faces() -> None:
    rng = np.random.default_rng(2)
    faces = fuse_faces(
        joined(wall_samples(A, B, 4, 0.003, rng), wall_samples(B, B + 2 * UP, 4, 0.003, rng)), FaceSettings()
    )
    assert len(set(faces.label[faces.label >= 0])) == 2


def test_a_step_wider_than_flat_is_kept() -> None:
    rng = np.random.default_rng(3)
    step = np.array([0.0, 0.08])
    near, far = wall_samples(A, B, 5, 0.003, rng), wall_samples(B + step, 2 * B + step, 5, 0.003, rng)
    faces = fuse_faces(joined(near, far), FaceSettings())
    first, second = (
        np.bincount(faces.label[: len(near.view)]).argmax(),
        np.bincount(faces.label[len(near.view) :]).argmax(),
    )
    assert abs((faces.centres[first] - faces.centres[second])[1]) > 0.07


def test_no_face_is_near_open_ground() -> None:
    faces = fuse_faces(wall_samples(A, B, 3, 0.003, np.random.default_rng(4)), FaceSettings())
    assert faces.nearest(np.array([[1.5, 1.0], [1.5, 0.0]]), np.array([[0.0, 1.0], [0.0, -1.0]]), 0.06).tolist() == [
        -1,
        -1,
    ]
