"""Claims about the strokes of a view."""

import numpy as np
import pytest

from backend.surfaces import surfaces_of
from backend.view import EdgeKind, View
from tests.backend.plan_rays import Rays, empty_room, view_of


def test_strokes_of_a_room_face_the_sensor_with_the_walls_own_directions() -> None:
    rng = np.random.default_rng(0)
    surfaces = surfaces_of(view_of(empty_room(), np.array([2.0, 1.5, 0.0]), Rays(), rng), 0.1, 0.01)
    normals = surfaces.normals[surfaces.sure]
    along_axis = np.abs(normals).max(axis=1)
    assert np.mean(along_axis > np.cos(np.radians(3))) > 0.95
    towards = np.sum(normals * surfaces.ring[surfaces.corner][surfaces.sure], axis=1)
    assert np.all(towards < 0)


def test_the_weights_add_up_to_the_length_of_measured_surface() -> None:
    view = view_of(empty_room(), np.array([3.0, 2.0, 0.0]), Rays(noise=0.0), np.random.default_rng(0))
    assert surfaces_of(view, 0.1, 0.01).weight.sum() == pytest.approx(20.0, rel=0.01)


def test_fake_edges_have_no_surface_and_are_not_cut() -> None:
    ring = np.array([[2.0, -2.0], [2.0, 2.0], [-2.0, 2.0], [-2.0, -2.0]])
    kinds = np.array([EdgeKind.REAL, EdgeKind.OCCLUSION, EdgeKind.NO_RETURN, EdgeKind.SIDE], dtype=np.uint8)
    surfaces = surfaces_of(View(ring, kinds, np.full(4, 0.02), np.zeros(2), np.empty((0, 2, 2))), 0.1, 0.01)
    assert len(surfaces.ring) == 4 + 39
    np.testing.assert_allclose(surfaces.ring[surfaces.corner][:, 0], 2.0)
    np.testing.assert_allclose(surfaces.normals, np.tile([-1.0, 0.0], (41, 1)), atol=1e-9)


def test_a_view_without_real_edges_has_no_surfaces() -> None:
    ring = np.array([[2.0, -2.0], [2.0, 2.0], [-2.0, 0.0]])
    kinds = np.full(3, EdgeKind.NO_RETURN, dtype=np.uint8)
    surfaces = surfaces_of(View(ring, kinds, np.full(3, 0.02), np.zeros(2), np.empty((0, 2, 2))), 0.1, 0.01)
    assert len(surfaces.corner) == 0


def test_strokes_too_short_for_the_noise_have_no_sure_direction() -> None:
    angles = np.linspace(-0.05, 0.05, 5)
    near = 3.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    ring = np.vstack([near, [[-1.0, 1.0], [-1.0, -1.0]]])
    kinds = np.array([EdgeKind.REAL] * 4 + [EdgeKind.SIDE] * 3, dtype=np.uint8)
    surfaces = surfaces_of(View(ring, kinds, np.full(7, 0.05), np.zeros(2), np.empty((0, 2, 2))), 0.2, 0.01)
    assert not surfaces.sure.any()
