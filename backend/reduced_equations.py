"""Reduced equations: what faces and wheels say of all poses, once the lines that nobody knows are eliminated.

Each line has two unknowns; eliminating them leaves equations among the poses that saw it (Schur complement). They are
never formed, as hundreds of poses may share a face: conjugate gradients only ever pull through the lines.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from backend.face_cells import Cells, Lines

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

SETTLED = 1e-4  # of the right side: what conjugate gradients may leave
LEAST = 1e-9  # information on every unknown: what nobody saw stays


class RefinementError(Exception):
    """The equations of the refinement could not be solved; the message says how far it came."""


@dataclass(frozen=True)
class Trust:
    """How far points are believed: Cauchy width and least spread in metres, and how many readings share an error."""

    width: float
    finest: float
    shared: int


@dataclass(frozen=True, eq=False)
class Equations:
    """Information (k, 3, 3) on each pose, (k − 1, 3, 3) between successive ones, and the gradient (k, 3).

    pulls: (p, 2, 3) how the pose of each pair (p,) in `owner` pulls at the line of its cell; starts: (c + 1,) where the
    pairs of each cell begin.
    """

    own: Floats
    between: Floats
    gradient: Floats
    pulls: Floats
    owner: Integers
    starts: Integers


def equations_of(poses: Floats, cells: Cells, lines: Lines, trust: Trust) -> Equations:
    """What the lines say of poses (k, 3)."""
    limits = np.array([trust.width, trust.finest, float(trust.shared)])
    own, gradient, pulls, owner, starts = _gathered(
        poses, cells.points, cells.spread, cells.owner, cells.starts, lines.centres, lines.normals, lines.kept, limits
    )
    return Equations(own, np.zeros((len(poses) - 1, 3, 3)), gradient, pulls, owner, starts)


def solved(equations: Equations) -> Floats:
    """The moves (k, 3) that settle them; the first pose stays. RefinementError if they do not settle.

    The chain of the poses and each one's own information make the preconditioner.
    """
    moves = np.zeros_like(equations.gradient)
    if len(moves) < 2:
        return moves
    # Exact numbers would settle in as many steps as there are unknowns; rounded ones take a few more.
    most = 10 * moves[1:].size
    moves[1:], left = _conjugate_gradients(
        equations.own[1:] + LEAST * np.eye(3), np.ascontiguousarray(equations.between[1:]),
        equations.pulls, equations.owner - 1, equations.starts, equations.gradient[1:], most,
    )  # fmt: skip
    if not left <= SETTLED:
        raise RefinementError(f"{len(moves)} poses did not settle in {most} steps: {left:.0e} of their errors is left")
    return moves


@njit(cache=True)  # type: ignore[untyped-decorator]
def _gathered(
    poses: Floats, points: Floats, spread: Floats, owner: Integers, starts: Integers,
    centres: Floats, normals: Floats, kept: NDArray[np.bool_], limits: Floats,
) -> tuple[Floats, Floats, Floats, Integers, Integers]:  # fmt: skip
    """Own information (k, 3, 3), gradient (k, 3), pulls (p, 2, 3), their poses (p,), and each cell's first (c + 1,)."""
    own, gradient = np.zeros((len(poses), 3, 3)), np.zeros((len(poses), 3))
    pulls, pulling = np.zeros((len(points), 2, 3)), np.empty(len(points), np.int64)
    first_pull, pairs = np.zeros(len(starts), np.int64), 0
    row = np.empty(3)
    for cell in range(len(kept)):
        first, last = starts[cell], starts[cell + 1]
        if kept[cell]:
            root, basis, seen = _whitened(points, spread, first, last, centres[cell], normals[cell], limits)
            for i in range(first, last):
                k, n = owner[i], i - first
                if i == first or k != owner[i - 1]:
                    pulling[pairs] = k
                    pairs += 1
                arm_x, arm_y = points[i, 0] - poses[k, 0], points[i, 1] - poses[k, 1]
                row[0], row[1] = root[n] * normals[cell, 0], root[n] * normals[cell, 1]
                row[2] = row[1] * arm_x - row[0] * arm_y
                for r in range(3):
                    gradient[k, r] += row[r] * seen[n]
                    for b in range(2):
                        pulls[pairs - 1, b, r] += basis[n, b] * row[r]
                    for c in range(3):
                        own[k, r, c] += row[r] * row[c]
        first_pull[cell + 1] = pairs
    return own, gradient, pulls[:pairs].copy(), pulling[:pairs].copy(), first_pull


@njit(cache=True)  # type: ignore[untyped-decorator]
def _whitened(
    points: Floats, spread: Floats, first: int, last: int, centre: Floats, normal: Floats, limits: Floats
) -> tuple[Floats, Floats, Floats]:
    """Root weights (n,) of points first…last, what moving and turning their line does to each (n, 2), as columns of
    length one, and the errors (n,) that no line explains."""
    count = last - first
    root, basis, seen = np.empty(count), np.empty((count, 2)), np.empty(count)
    total, middle, square = 1e-12, 0.0, 1e-12
    for i in range(count):
        dx, dy = points[first + i, 0] - centre[0], points[first + i, 1] - centre[1]
        error = dx * normal[0] + dy * normal[1]
        weight = 1 / (1 + (error / max(limits[0], 2 * spread[first + i])) ** 2)
        root[i] = np.sqrt(weight / limits[2]) / max(spread[first + i], limits[1])
        basis[i, 0], basis[i, 1] = root[i], normal[0] * dy - normal[1] * dx
        seen[i] = root[i] * error
        total += root[i] * root[i]
        middle += root[i] * root[i] * basis[i, 1]
    middle /= total
    for i in range(count):
        basis[i, 0] /= np.sqrt(total)
        basis[i, 1] = root[i] * (basis[i, 1] - middle)
        square += basis[i, 1] * basis[i, 1]
    for b in range(2):
        explained = 0.0
        for i in range(count):
            if b == 1:
                basis[i, 1] /= np.sqrt(square)
            explained += basis[i, b] * seen[i]
        for i in range(count):
            seen[i] -= basis[i, b] * explained
    return root, basis, seen


@njit(cache=True)  # type: ignore[untyped-decorator]
def _conjugate_gradients(
    own: Floats, between: Floats, pulls: Floats, owner: Integers, starts: Integers, right: Floats, most: int
) -> tuple[Floats, float]:
    """The solution (k, 3) after `most` steps or when it has settled, and what share of the right side is left."""
    pivots = _pivots(own, between)
    found, rest = np.zeros_like(right), right.copy()
    along = _through_chain(pivots, between, rest)
    product, whole = np.sum(rest * along), max(np.sum(right * right), 1e-300)
    for _ in range(most):
        if np.sum(rest * rest) <= SETTLED**2 * whole:
            break
        pulled = _applied(own, between, pulls, owner, starts, along)
        share = product / np.sum(along * pulled)
        found += share * along
        rest -= share * pulled
        nearest = _through_chain(pivots, between, rest)
        before, product = product, np.sum(rest * nearest)
        along = nearest + product / before * along
    return found, np.sqrt(np.sum(rest * rest) / whole)


@njit(cache=True)  # type: ignore[untyped-decorator]
def _applied(own: Floats, between: Floats, pulls: Floats, owner: Integers, starts: Integers, moves: Floats) -> Floats:
    """The equations times moves (k, 3)."""
    product = np.zeros_like(moves)
    for k in range(len(own)):
        for r in range(3):
            for c in range(3):
                product[k, r] += own[k, r, c] * moves[k, c]
                if k > 0:
                    product[k, r] += between[k - 1, c, r] * moves[k - 1, c]
                    product[k - 1, r] += between[k - 1, r, c] * moves[k, c]
    line = np.empty(2)
    for cell in range(len(starts) - 1):
        line[:] = 0.0
        for pair in range(starts[cell], starts[cell + 1]):
            if owner[pair] >= 0:
                for b in range(2):
                    for c in range(3):
                        line[b] += pulls[pair, b, c] * moves[owner[pair], c]
        for pair in range(starts[cell], starts[cell + 1]):
            if owner[pair] >= 0:
                for c in range(3):
                    product[owner[pair], c] -= pulls[pair, 0, c] * line[0] + pulls[pair, 1, c] * line[1]
    return product


@njit(cache=True)  # type: ignore[untyped-decorator]
def _pivots(own: Floats, between: Floats) -> Floats:
    """Inverse pivots (k, 3, 3) of the chain's elimination, pose by pose."""
    pivots = np.empty_like(own)
    for k in range(len(own)):
        pivot = own[k].copy()
        if k > 0:
            pivot -= between[k - 1].T @ pivots[k - 1] @ between[k - 1]
        pivots[k] = np.linalg.inv(pivot)
    return pivots


@njit(cache=True)  # type: ignore[untyped-decorator]
def _through_chain(pivots: Floats, between: Floats, right: Floats) -> Floats:
    """The solution (k, 3) of the chain alone: each pose's own information and what ties it to the next."""
    found = np.empty_like(right)
    rest = np.empty(3)
    for k in range(len(right)):
        rest[:] = right[k]
        if k > 0:
            for r in range(3):
                for c in range(3):
                    rest[r] -= between[k - 1, c, r] * found[k - 1, c]
        for r in range(3):
            found[k, r] = pivots[k, r, 0] * rest[0] + pivots[k, r, 1] * rest[1] + pivots[k, r, 2] * rest[2]
    for k in range(len(right) - 2, -1, -1):
        for r in range(3):
            rest[r] = (
                between[k, r, 0] * found[k + 1, 0]
                + between[k, r, 1] * found[k + 1, 1]
                + between[k, r, 2] * found[k + 1, 2]
            )
        for r in range(3):
            found[k, r] -= pivots[k, r, 0] * rest[0] + pivots[k, r, 1] * rest[1] + pivots[k, r, 2] * rest[2]
    return found
