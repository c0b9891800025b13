"""Claims about re-expressing boundaries on fused faces."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
import shapely.affinity
from shapely import Polygon, box

from backend.contours import contours
from backend.snapping import snap_ring, snap_view
from backend.surfaces import surfaces_of
from backend.view import EdgeKind, View
from backend.wall_faces import FaceSettings, WallFaces, fuse_faces
from tests.backend.placed_samples import joined, wall_samples

CELL = 0.025


def faces_of_room(tilt: float) -> tuple[Polygon, WallFaces]:
    """A room 3 × 2 m, turned by `tilt` radians, and the faces that views fused of it."""
    room = shapely.affinity.rotate(box(0.013, 0.017, 3.013, 2.017), tilt, origin=(0, 0), use_radians=True)
    corner = np.asarray(shapely.orient_polygons(room).exterior.coords)
    rng = np.random.default_rng(0)
    walls = [wall_samples(a, b, 4, 0.002, rng) for a, b in pairwise(corner)]
    return room, fuse_faces(joined(*walls), FaceSettings())


def traced(room: Polygon) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """The ring of the room's cells."""
    x0, y0, x1, y1 = room.buffer(0.2).bounds
    x, y = np.meshgrid(np.arange(x0, x1, CELL), np.arange(y0, y1, CELL))
    (ring,) = contours(shapely.contains_xy(room, x + 0.5 * CELL, y + 0.5 * CELL))
    return ring * CELL + [x0, y0]


def test_a_staircase_of_cells_becomes_the_four_walls_again() -> None:
    for tilt in (0.0, 0.2, 0.6):
        room, faces = faces_of_room(tilt)
        snapped = Polygon(snap_ring(traced(room), faces, 0.06))
        assert snapped.symmetric_difference(room).area < 0.006 * room.area
        assert len(snapped.exterior.coords) == 5


def test_a_boundary_that_no_face_explains_stays_as_traced() -> None:
    _, faces = faces_of_room(0.0)
    far = traced(box(10, 10, 11, 11))
    np.testing.assert_array_equal(snap_ring(far, faces, 0.06), far)


def test_corners_of_a_view_move_along_their_beams_only() -> None:
    _, faces = faces_of_room(0.0)
    angles = np.linspace(-0.4, 0.4, 40)
    origin = np.array([1.0, 1.0])
    ring = np.vstack(
        [origin + (2.04 / np.cos(angles))[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1), origin]
    )
    kinds = np.full(41, EdgeKind.REAL, dtype=np.uint8)
    kinds[-2:] = EdgeKind.SIDE
    view = View(ring, kinds, np.full(41, 0.02), origin, np.empty((0, 2, 2)))
    surfaces = surfaces_of(view, 1.0, 0.01)
    label = faces.nearest(ring[surfaces.corner], surfaces.normals, 0.1)
    before, after = surfaces.ring - origin, snap_view(surfaces.ring, origin, surfaces, label, faces) - origin
    np.testing.assert_allclose(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], 0, atol=1e-9)
    assert np.abs(after[surfaces.corner, 0] - 2.013).max() < 0.005


@pytest.mark.parametrize(("level", "slope"), [(1.56, 0.4), (1.48, 0.3)])
def test_a_stray_face_past_a_walls_end_draws_no_spike(level: float, slope: float) -> None:
    wall = Polygon([(0, 1.5), (1.8, 1.5), (1.5, 1.6), (0, 1.6)])
    room = Polygon(shapely.get_coordinates(box(0.0, 0.0, 4.0, 3.0).difference(wall)))
    corner = np.asarray(shapely.orient_polygons(room).exterior.coords)
    rng = np.random.default_rng(0)
    long = [pair for pair in pairwise(corner) if np.linalg.norm(pair[1] - pair[0]) > 0.5]
    start = np.array([1.25, level + 0.5 * slope])
    stray = wall_samples(start, start + np.array([1.6, -1.6 * slope]), 1, 0.002, rng)
    faces = fuse_faces(joined(*(wall_samples(*pair, 4, 0.002, rng) for pair in long), stray), FaceSettings())
    snapped = Polygon(snap_ring(traced(room), faces, 0.06))
    assert shapely.hausdorff_distance(snapped.exterior, room.exterior, 0.05) < 0.06
