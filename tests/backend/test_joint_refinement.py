"""Joint refinement: disturbed poses in a known room come back, the wheels hold a corridor, the first pose stays."""

from itertools import pairwise

import numpy as np
import pytest

from backend.face_cells import Sheaf
from backend.joint_refinement import Chain, Floats, RefinementSettings, refine

ROOM = ((0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0))
SETTINGS = RefinementSettings()


def walls(corners: tuple[tuple[float, float], ...], step: float = 0.05) -> tuple[Floats, Floats]:
    """Points (n, 2) and inward normals (n, 2) of a counter-clockwise ring."""
    points, normals = [], []
    for start, end in zip(np.array(corners), np.roll(np.array(corners), -1, axis=0), strict=True):
        length = np.linalg.norm(end - start)
        along = (end - start) / length
        points.append(start + along * np.arange(step, length - step, step)[:, None])
        normals.append(np.repeat([[-along[1], along[0]]], len(points[-1]), axis=0))
    return np.concatenate(points), np.concatenate(normals)


def turned(vectors: Floats, angle: float) -> Floats:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(vectors @ np.array([[cosine, -sine], [sine, cosine]]).T)


def seen(poses: Floats, points: Floats, normals: Floats, noise: float, rng: np.random.Generator) -> Sheaf:
    """Every pose sees everything, with noise across the walls."""
    parts = [turned(points + noise * rng.normal(size=(len(points), 1)) * normals - p[:2], -p[2]) for p in poses]
    owner = np.repeat(np.arange(len(poses)), len(points))
    facing = np.concatenate([turned(normals, -p[2]) for p in poses])
    return Sheaf(np.concatenate(parts), facing, np.full(len(owner), noise), owner)


def wheels(poses: Floats, sigma: Floats) -> Chain:
    moves = [np.array([*turned(b[:2] - a[:2], -a[2]), b[2] - a[2]]) for a, b in pairwise(poses)]
    return Chain(np.array(moves), np.repeat(np.diag(sigma**2)[None], len(moves), axis=0))


def drive(count: int) -> Floats:
    s = np.linspace(0, 1, count)
    return np.column_stack([1 + 4 * s, 2 + np.sin(3 * s), 0.5 * s])


@pytest.mark.parametrize("seed", range(3))
def test_disturbed_poses_come_back_to_the_walls_they_share(seed: int) -> None:
    rng = np.random.default_rng(seed)
    true = drive(12)
    disturbed = true + rng.normal(0, 1, true.shape) * [0.015, 0.015, 0.003]
    disturbed[0] = true[0]
    sheaf = seen(true, *walls(ROOM), 0.01, rng)
    found = refine(disturbed, sheaf, wheels(true, np.array([0.1, 0.1, 0.05])), SETTINGS)
    assert np.max(np.abs(found - true)[:, :2]) < 0.005
    assert np.max(np.abs(found - true)[:, 2]) < 0.002
    assert np.array_equal(found[0], true[0])


def test_along_a_smooth_corridor_the_wheels_decide() -> None:
    rng = np.random.default_rng(5)
    true = np.column_stack([np.linspace(0, 5, 10), np.full(10, 1.0), np.zeros(10)])
    points = np.concatenate([np.linspace((-20, 0), (25, 0), 900), np.linspace((-20, 2), (25, 2), 900)])
    normals = np.repeat([[0.0, 1.0], [0.0, -1.0]], 900, axis=0)
    disturbed = true.copy()
    disturbed[1:] += rng.normal(0, 1, (9, 3)) * [0.05, 0.01, 0.002]
    sheaf = seen(true, points, normals, 0.01, rng)
    found = refine(disturbed, sheaf, wheels(true, np.full(3, 0.02)), SETTINGS)
    assert np.max(np.abs(found - true)[:, 1]) < 0.005
    assert np.max(np.abs(found - true)[:, 0]) < 0.005  # noisy directions of the walls would draw it 2 cm astray


def test_two_faces_of_a_thin_wall_are_never_one_line() -> None:
    """Half of the poses see one side of a wall of 10 cm, half the other: the thickness is still there afterwards."""
    rng = np.random.default_rng(6)
    true = drive(10)
    upper = np.linspace((0, 3.5), (6, 3.5), 120)
    outer, outer_normals = walls(ROOM)
    room = seen(true, outer, outer_normals, 0.01, rng)
    faces = [
        seen(
            true[k : k + 1],
            upper + np.array([0, 0.1 * (k % 2)]),
            np.full((120, 2), [0.0, 1.0 if k % 2 else -1.0]),
            0.01,
            rng,
        )
        for k in range(10)
    ]
    sheaf = Sheaf(
        np.concatenate([room.points, *(face.points for face in faces)]),
        np.concatenate([room.normals, *(face.normals for face in faces)]),
        np.full(len(room.owner) + 1200, 0.01),
        np.concatenate([room.owner, np.repeat(np.arange(10), 120)]),
    )
    found = refine(true, sheaf, wheels(true, np.array([0.1, 0.1, 0.05])), SETTINGS)
    assert np.max(np.abs(found - true)[:, :2]) < 0.005


def test_faces_that_no_line_holds_leave_the_wheels_alone() -> None:
    rng = np.random.default_rng(7)
    true = drive(2)
    scattered = rng.uniform(0, 9, (40, 2))  # nowhere enough of them in one place to be a wall
    sheaf = seen(true, scattered, np.tile([1.0, 0.0], (40, 1)), 0.01, rng)
    assert refine(true, sheaf, wheels(true, np.full(3, 0.02)), SETTINGS) == pytest.approx(true)


def test_the_order_of_the_surface_does_not_matter() -> None:
    rng = np.random.default_rng(8)
    true = drive(6)
    disturbed = true + rng.normal(0, 0.01, true.shape)
    sheaf, chain = seen(true, *walls(ROOM), 0.01, rng), wheels(true, np.array([0.1, 0.1, 0.05]))
    shuffled = rng.permutation(len(sheaf.owner))
    other = Sheaf(sheaf.points[shuffled], sheaf.normals[shuffled], sheaf.spread[shuffled], sheaf.owner[shuffled])
    assert refine(disturbed, other, chain, SETTINGS) == pytest.approx(refine(disturbed, sheaf, chain, SETTINGS))
