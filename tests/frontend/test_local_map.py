"""Local maps: faces are placed, turned and chosen by the side they show."""

import numpy as np
import pytest
from scipy.spatial import cKDTree
from shapely import box

from frontend.local_map import Faces, LocalMap
from frontend.rigid_motion import compose, inverse
from tests.simulated_drives import faces_from, furnished_room, surface_at, world_of

ROOM_CENTRE = np.array([2.5, 2.5, 0.0])


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)


def test_placed_faces_lie_on_the_walls_and_look_at_who_saw_them(rng: np.random.Generator) -> None:
    pose = np.array([2.0, 3.0, 1.0])
    faces = Faces.placed(surface_at(world_of(box(0, 0, 5, 4)), pose, rng), pose)
    x, y = faces.points.T
    off_wall = np.min(np.abs([x, x - 5, y, y - 4]), axis=0)
    assert np.median(off_wall) < 0.015
    assert np.max(off_wall) < 0.1
    np.testing.assert_allclose(np.linalg.norm(faces.normals, axis=1), 1)
    assert np.all(np.sum((pose[:2] - faces.points) * faces.normals, axis=1) > 0)


def test_faces_moved_there_and_back_are_where_they_were(rng: np.random.Generator) -> None:
    faces = faces_from(furnished_room(rng), [ROOM_CENTRE], rng)
    pose = np.array([3.0, -2.0, 2.5])
    back = faces.moved(pose).moved(inverse(pose))
    np.testing.assert_allclose(back.points, faces.points, atol=1e-12)
    np.testing.assert_allclose(back.normals, faces.normals, atol=1e-12)


def test_placing_is_moving_what_was_placed_at_the_origin(rng: np.random.Generator) -> None:
    surface = surface_at(furnished_room(rng), ROOM_CENTRE, rng)
    first, second = np.array([1.0, 2.0, 0.5]), np.array([-0.3, 0.1, 1.1])
    placed = Faces.placed(surface, compose(first, second))
    moved = Faces.placed(surface, second).moved(first)
    np.testing.assert_allclose(placed.points, moved.points, atol=1e-12)
    np.testing.assert_allclose(placed.normals, moved.normals, atol=1e-12)


def test_only_faces_that_turn_to_the_viewpoint_and_lie_in_reach_are_facing_it() -> None:
    """A wall of 10 cm has two sides: who stands south of it can only meet its southern faces."""
    x = np.linspace(0, 4, 41)
    south = Faces(np.column_stack([x, np.zeros(41)]), np.tile([0.0, -1.0], (41, 1)))
    north = Faces(np.column_stack([x, np.full(41, 0.1)]), np.tile([0.0, 1.0], (41, 1)))
    seen = Faces.together([south, north]).facing(np.array([2.0, -1.0]), 1.5)
    assert np.all(seen.points[:, 1] == 0)
    np.testing.assert_array_equal(seen.points[:, 0], x[np.hypot(x - 2, 1) < 1.5])


def test_a_local_map_holds_every_face_once(rng: np.random.Generator) -> None:
    faces = faces_from(furnished_room(rng), [ROOM_CENTRE, ROOM_CENTRE + np.array([0.3, 0, 1])], rng)
    kept = LocalMap.of(faces).faces
    wanted = np.column_stack([faces.points, faces.normals])
    held = np.column_stack([kept.points, kept.normals])
    np.testing.assert_array_equal(held[np.lexsort(held.T)], wanted[np.lexsort(wanted.T)])


@pytest.mark.parametrize("seed", range(5))
def test_what_lies_near_the_map_and_on_its_lines_is_what_trees_find(seed: int) -> None:
    """By place alone, and by place and facing side, a unit of normal counting as a metre."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-np.pi, np.pi, (2, 150))
    faces, placed = (
        Faces(rng.uniform(-3, 3, (150, 2)) * stretch, np.column_stack([np.cos(a), np.sin(a)]))
        for a, stretch in zip(angles, (1.0, 1.3), strict=True)
    )
    near, on = LocalMap.of(faces).lying(placed, 0.6, 0.15)
    expected = cKDTree(faces.points).query(placed.points)[0] < 0.6
    both = cKDTree(np.hstack([faces.points, faces.normals]))
    apart, partners = both.query(np.hstack([placed.points, placed.normals]))
    across = np.sum((placed.points - faces.points[partners]) * faces.normals[partners], axis=1)
    np.testing.assert_array_equal(near, expected)
    np.testing.assert_array_equal(on, (apart < 0.6) & (np.abs(across) < 0.15))
    assert 10 < np.count_nonzero(on) < np.count_nonzero(near) < 150
