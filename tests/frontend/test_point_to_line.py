"""Point to line: the compiled search and descent agree with slow, obvious ones in numpy and scipy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from frontend.local_map import CELL, Faces, LocalMap
from frontend.point_to_line import descend, nearest_face, paired, shared_errors, sort_into_cells
from frontend.rigid_motion import rotation, transform
from frontend.scan import Floats

seeds = st.integers(0, 2**32 - 1)
laws = settings(deadline=None, max_examples=25)


def random_faces(rng: np.random.Generator, count: int) -> Faces:
    angles = rng.uniform(-np.pi, np.pi, count)
    return Faces(rng.uniform(-3, 3, (count, 2)), np.column_stack([np.cos(angles), np.sin(angles)]))


def corner_faces(count: int) -> Faces:
    """Three walls of a room 4 × 3 m, their faces a few centimetres apart."""
    along = np.linspace(0, 1, count)[:, None]
    walls = [((0, 0), (4, 0), (0, 1)), ((0, 0), (0, 3), (1, 0)), ((4, 0), (4, 3), (-1, 0))]
    points = np.concatenate([np.array(a) + along * (np.array(b) - np.array(a)) for a, b, _ in walls])
    return Faces(points, np.repeat(np.array([n for _, _, n in walls], float), count, axis=0))


def descended(own: Faces, fixed: Faces, start: Floats, prior: Floats, passes: Floats) -> tuple[Floats, Floats]:
    """Pose and information from the compiled descent."""
    m = LocalMap.of(fixed)
    pose, information, _, _ = descend(
        own.points, own.normals, m.faces.points, m.faces.normals, m.first, m.corner, m.columns, m.rows,
        start, start, prior, passes,
    )  # fmt: skip
    return pose, information


@laws
@given(seeds, st.integers(1, 300), st.floats(0.05, 1.0))
def test_sorting_into_cells_loses_nothing_and_puts_every_point_into_its_cell(
    seed: int, count: int, cell: float
) -> None:
    points = np.random.default_rng(seed).normal(0, 2, (count, 2))
    order, first, corner, columns, rows = sort_into_cells(points, cell)
    np.testing.assert_array_equal(np.sort(order), np.arange(count))
    assert first[0] == 0
    assert first[-1] == count
    cells = np.repeat(np.arange(columns * rows), np.diff(first))
    wanted = np.floor((points[order] - corner) / cell).astype(int)
    np.testing.assert_array_equal(cells, wanted[:, 0] * rows + wanted[:, 1])


@laws
@given(seeds, st.floats(0.05, 0.9), st.floats(-0.9, 0.95))
def test_the_nearest_face_that_looks_the_same_way_is_found(seed: int, reach: float, alike: float) -> None:
    rng = np.random.default_rng(seed)
    m = LocalMap.of(random_faces(rng, 200))
    asked = random_faces(rng, 40)
    limits = np.array([CELL, reach, alike])
    for point, normal in zip(asked.points * 1.2, asked.normals, strict=True):
        distances = np.linalg.norm(m.faces.points - point, axis=1)
        distances[(m.faces.normals @ normal <= alike) | (distances >= reach)] = np.inf
        expected = int(np.argmin(distances)) if np.isfinite(distances).any() else -1
        found = nearest_face(
            point, normal, m.faces.points, m.faces.normals, m.first, m.corner, m.columns, m.rows, limits
        )
        assert found == expected


@laws
@given(seeds)
def test_faces_of_opposite_sides_are_never_partners(seed: int) -> None:
    rng = np.random.default_rng(seed)
    faces = random_faces(rng, 200)
    m = LocalMap.of(faces)
    for point, normal in zip(m.faces.points, m.faces.normals, strict=True):
        found = nearest_face(
            point, -normal, m.faces.points, m.faces.normals, m.first, m.corner, m.columns, m.rows,
            np.array([CELL, 0.5, 0.8]),
        )  # fmt: skip
        assert found < 0 or m.faces.normals[found] @ normal < -0.8


@pytest.mark.parametrize("seed", range(6))
def test_the_descent_ends_where_least_squares_over_the_same_cost_ends(seed: int) -> None:
    """Each wall is a line, so any partner on it gives the same distance and scipy can minimise the cost itself."""
    rng = np.random.default_rng(seed)
    fixed, width = corner_faces(400), 0.1
    truth = np.array([0.05, -0.04, 0.03]) * rng.uniform(-1, 1, 3)
    own = corner_faces(60)
    inside = np.flatnonzero(np.all((own.points > 0.3) | (own.points == 0), axis=1) & (own.points[:, 0] != 0))
    kept = inside[own.points[inside, 1] < 2.7]
    noisy = own.points[kept] + own.normals[kept] * rng.normal(0, 0.02, (len(kept), 1))
    own = Faces(noisy, own.normals[kept])
    moved = Faces(transform(own.points, truth), own.normals @ rotation(truth[2]).T)
    prior = np.diag([300.0, 200.0, 400.0])
    passes = np.array([(CELL, 0.5, 0.8, width, 60.0)])

    offsets = np.where(np.abs(own.normals[:, 0]) > 0.5, np.where(own.normals[:, 0] > 0, 0.0, -4.0), 0.0)

    def residuals(pose: Floats) -> Floats:
        across = np.sum(transform(moved.points, pose) * own.normals, axis=1) - offsets
        return np.concatenate([np.sqrt(np.log1p((across / width) ** 2)), np.sqrt(np.diag(prior)) * pose])

    expected = least_squares(residuals, np.zeros(3), xtol=1e-14, ftol=1e-14, gtol=1e-14).x
    found, _ = descended(moved, fixed, np.zeros(3), prior, passes)
    np.testing.assert_allclose(found, expected, atol=2e-4)


def test_the_information_is_that_of_the_matched_faces() -> None:
    """One wall of n faces along x tells y and the heading, with the lever arms of its points, and nothing of x."""
    x = np.linspace(-1, 1, 41)
    wall = Faces(np.column_stack([x, np.zeros(41)]), np.tile([0.0, 1.0], (41, 1)))
    _, information = descended(wall, wall, np.zeros(3), np.zeros((3, 3)), np.array([(CELL, 0.2, 0.8, 0.1, 5.0)]))
    np.testing.assert_allclose(information, np.diag([0.0, 41.0, float(np.sum(x**2))]), atol=1e-9)


def test_where_nothing_is_in_reach_the_guess_stays_and_nothing_is_known() -> None:
    wall = corner_faces(50)
    far = wall.moved(np.array([50.0, 0, 0]))
    start = np.array([0.1, 0.2, 0.3])
    pose, information = descended(wall, far, start, np.eye(3), np.array([(CELL, 0.5, 0.8, 0.1, 5.0)]))
    np.testing.assert_allclose(pose, start)
    np.testing.assert_array_equal(information, 0)


@pytest.mark.parametrize("alike", [1, 2, 4])
def test_errors_that_neighbours_share_count_as_fewer(alike: int) -> None:
    """Moving means of m independent errors have correlations (m − k) / m, whose sum on both sides makes m of one."""
    rng = np.random.default_rng(0)
    errors = np.convolve(rng.normal(0, 0.01, 4000 + alike - 1), np.ones(alike), "valid")
    assert shared_errors(errors, np.arange(len(errors)), 6) == pytest.approx(alike, rel=0.15, abs=0.15)


def test_only_readings_that_far_apart_are_compared() -> None:
    errors = np.tile([0.01, 0.01, -0.01, -0.01], 50)
    near, far = np.arange(200), 100 * np.arange(200)
    assert shared_errors(errors, far, 6) == 1.0
    assert shared_errors(errors, near, 1) == pytest.approx(1.0, abs=0.02)
    assert shared_errors(np.ones(200), near, 3) == pytest.approx(7.0)


def test_pairs_leave_out_what_has_no_partner_and_their_errors_are_those_across_the_faces() -> None:
    """Errors of one size and sign at successive readings are one error; alone, each counts for itself."""
    fixed = corner_faces(40)
    own, partners = fixed.points + np.array([0.0, 0.01]), np.arange(120)
    partners[5:9] = -1
    pairs, shared = paired(own, partners, fixed.points, fixed.normals, partners, np.zeros(3), 2)
    np.testing.assert_array_equal(pairs, np.column_stack([np.flatnonzero(partners >= 0)] * 2))
    assert shared == pytest.approx(5.0, rel=0.1)
    assert paired(own, 10 * np.arange(120), fixed.points, fixed.normals, partners, np.zeros(3), 2)[1] == 1.0
