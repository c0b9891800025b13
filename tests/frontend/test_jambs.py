from typing import Any

import numpy as np
from shapely import Polygon, box
from shapely.geometry.base import BaseGeometry

from frontend.jambs import JambSettings, find_jambs
from frontend.scan import Floats
from tests.frontend.rooms import corners_of, traced

ROOM = box(0, 0, 8, 6)
POLE = Polygon([(3.95, 2.95), (4.05, 2.95), (4.05, 3.05), (3.95, 3.05)])
SCREEN = box(4.0, 2.0, 4.1, 4.0)


def jambs_in(room: BaseGeometry, pose: Floats, seed: int = 0) -> Any:
    contour = traced(room, pose, seed=seed)
    v = contour.vertices
    return find_jambs(contour.points[v], contour.spread[v], contour.edge_kinds[v], contour.origin, JambSettings())


def test_the_ends_of_a_screen_are_jambs_that_stay_where_they_are() -> None:
    room = ROOM.difference(SCREEN)
    for pose in ([1.0, 3.0, 0.2], [1.5, 2.0, -0.4], [2.0, 3.5, 0.0]):
        found = jambs_in(room, np.array(pose))
        off = np.linalg.norm(found.positions[:, None] - corners_of(SCREEN, np.array(pose))[None], axis=2)
        assert found.positions.shape[0] == 2
        assert np.all(np.min(off, axis=1) < 0.08)


def test_a_jamb_faces_the_sensor_and_knows_its_one_wall() -> None:
    found = jambs_in(ROOM.difference(SCREEN), np.array([1.0, 3.0, 0.0]))
    assert np.all(np.sum(~np.isnan(found.walls), axis=1) == 1)
    assert np.all(np.cos(found.headings) < 0)
    known = found.walls[~np.isnan(found.walls)]
    assert np.allclose(np.cos(known - np.pi / 2), 1.0, atol=0.01)  # counter-clockwise, up a wall ahead


def test_a_pole_is_one_bump_and_no_pair_of_jambs() -> None:
    found = jambs_in(ROOM.difference(POLE), np.array([2.0, 3.0, 0.0]))
    assert found.bumps.tolist() == [True]
    assert np.allclose(found.positions, [[1.95, 0.0]], atol=0.05)


def test_the_covariances_say_how_far_off_the_jambs_are() -> None:
    room, errors = ROOM.difference(SCREEN), []
    rng = np.random.default_rng(0)
    for seed in range(60):
        pose = np.array([rng.uniform(0.8, 2.2), rng.uniform(2.2, 3.8), 0.0])
        found = jambs_in(room, pose, seed)
        near = corners_of(SCREEN, pose)
        off = found.positions - near[np.argmin(np.linalg.norm(found.positions[:, None] - near[None], axis=2), axis=1)]
        errors.extend(np.einsum("ji,jik,jk->j", off, np.linalg.inv(found.covariances), off))
    assert 0.5 < np.mean(errors) < 4.0


def test_an_empty_room_has_no_jambs() -> None:
    assert not jambs_in(ROOM, np.array([2.0, 2.0, 0.0])).turns.size
