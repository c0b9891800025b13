"""Reduced equations: eliminating the lines changes no answer, and what cannot be solved says so."""

from dataclasses import replace

import numpy as np
import pytest

from backend.face_cells import Cells, Lines
from backend.reduced_equations import Equations, RefinementError, Trust, equations_of, solved

TRUST = Trust(width=1e9, finest=0.02, shared=1)  # no robust weights: the equations are linear
POSES = np.array([[0.0, 0.0, 0.0], [0.5, 0.1, 0.2], [1.0, 0.3, -0.1]])


def seen(rng: np.random.Generator) -> tuple[Cells, Lines]:
    """Six cells on walls of all directions, each seen from every pose, nine points a pose."""
    turns = np.linspace(0, np.pi, 6, endpoint=False)
    normals = np.column_stack([-np.sin(turns), np.cos(turns)])
    centres = rng.uniform(-3, 3, (6, 2))
    cell, owner = np.repeat(np.arange(6), 27), np.tile(np.repeat(np.arange(3), 9), 6)
    along = np.column_stack([normals[:, 1], -normals[:, 0]])
    points = (
        centres[cell] + rng.uniform(-0.3, 0.3, (162, 1)) * along[cell] + rng.normal(0, 0.02, (162, 1)) * normals[cell]
    )
    cells = Cells(points, normals[cell], np.full(162, 0.02), owner, np.arange(0, 163, 27), np.zeros((6, 3), np.int64))
    return cells, Lines(centres, normals, np.ones(6, np.bool_), *np.ones((3, 6)))


def with_a_prior(equations: Equations) -> Equations:
    return Equations(
        equations.own + 10 * np.eye(3), equations.between, equations.gradient, equations.pulls, equations.owner,
        equations.starts,
    )  # fmt: skip


def test_it_is_as_if_all_lines_had_been_solved_beside_the_poses() -> None:
    cells, lines = seen(np.random.default_rng(1))
    cell = np.repeat(np.arange(6), 27)
    off, normals = cells.points - lines.centres[cell], lines.normals[cell]
    arm = cells.points - POSES[cells.owner, :2]
    rows = np.zeros((162, 9 + 12))
    for k in range(2):
        rows[np.arange(162), 3 * cells.owner + k] = normals[:, k]
    rows[np.arange(162), 3 * cells.owner + 2] = normals[:, 1] * arm[:, 0] - normals[:, 0] * arm[:, 1]
    rows[np.arange(162), 9 + 2 * cell] = -1
    rows[np.arange(162), 10 + 2 * cell] = normals[:, 1] * off[:, 0] - normals[:, 0] * off[:, 1]
    errors = np.sum(off * normals, axis=1)
    prior = np.zeros(21)
    prior[3:9] = 10
    all_at_once = np.linalg.lstsq(
        np.vstack([rows[:, 3:] / 0.02, np.diag(np.sqrt(prior))[3:9, 3:]]),
        np.append(errors / 0.02, np.zeros(6)),
        rcond=None,
    )[0]
    moves = solved(with_a_prior(equations_of(POSES, cells, lines, TRUST)))
    np.testing.assert_allclose(moves[1:].ravel(), all_at_once[:6], atol=1e-5)


def test_the_first_pose_stays() -> None:
    cells, lines = seen(np.random.default_rng(2))
    moves = solved(with_a_prior(equations_of(POSES, cells, lines, TRUST)))
    assert np.all(moves[0] == 0)
    assert np.all(moves[1:] != 0)


def test_a_line_that_is_not_kept_says_nothing() -> None:
    cells, lines = seen(np.random.default_rng(3))
    nothing = equations_of(POSES, cells, replace(lines, kept=np.zeros(6, np.bool_)), TRUST)
    assert not nothing.own.any()
    assert not nothing.gradient.any()
    assert len(nothing.owner) == 0


def test_ties_between_successive_poses_alone_are_solved_at_once() -> None:
    """Two poses and a chain: the preconditioner is the whole system."""
    rng = np.random.default_rng(4)
    factors = rng.normal(size=(12, 12))
    whole = factors @ factors.T + np.eye(12)
    blocks = whole.reshape(4, 3, 4, 3).transpose(0, 2, 1, 3)
    chain = np.zeros_like(blocks)
    for k in range(4):
        for other in range(max(0, k - 1), min(4, k + 2)):
            chain[k, other] = blocks[k, other]
    own, between = (
        np.array([chain[k, k] + 20 * np.eye(3) for k in range(4)]),
        np.array([chain[k, k + 1] for k in range(3)]),
    )
    right = rng.normal(size=(4, 3))
    found = solved(Equations(own, between, right, np.zeros((0, 2, 3)), np.empty(0, np.int64), np.zeros(1, np.int64)))
    pulled = np.einsum("kij,kj->ki", own, found)
    pulled[:-1] += np.einsum("kij,kj->ki", between, found[1:])
    pulled[1:] += np.einsum("kji,kj->ki", between, found[:-1])
    np.testing.assert_allclose(pulled[1:], right[1:], atol=1e-5)


def test_equations_that_do_not_settle_are_an_error() -> None:
    nowhere = Equations(
        np.array([np.eye(3), np.eye(3)]), np.zeros((1, 3, 3)), np.full((2, 3), np.nan),
        np.zeros((0, 2, 3)), np.empty(0, np.int64), np.zeros(1, np.int64),
    )  # fmt: skip
    with pytest.raises(RefinementError, match="2 poses did not settle in 30 steps"):
        solved(nowhere)
