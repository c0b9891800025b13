"""Joint refinement: all keyframes and wall faces solved together, as in bundle adjustment with the lines eliminated.

Oriented surface points of all keyframes are hashed into cells by place and facing side. The points of a cell lie on one
line that nobody knows; eliminating its two parameters leaves an equation among the poses that saw it. The odometry
stays in as its own chain, or a smooth corridor would slide along itself.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, eye_array
from scipy.sparse.linalg import splu

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


SETTLED = 1e-4  # of the right side: what conjugate gradients may leave


class RefinementError(Exception):
    """The equations of the refinement could not be solved; the message says how far it came."""


@dataclass(frozen=True)
class RefinementSettings:
    """How the faces are cut and how far they are trusted."""

    cells: tuple[float, ...] = (0.5, 0.5)  # metres, one per round; larger bends curved walls straight
    sectors: int = 12  # facing sides told apart; more separates walls that meet at a blunt angle
    least_views: int = 3  # keyframes a cell needs; larger trusts only what many saw
    thickest: float = 0.04  # metres rms of a cell that is still one wall, or twice its spread; larger takes curves
    width: float = 0.03  # Cauchy width of a point off its line, metres, or twice its spread; larger trusts outliers
    finest: float = 0.015  # metres; no point is believed nearer to its line; larger trusts the wheels more
    shared_beams: int = 7  # readings that share one line fit; larger trusts the faces less


@dataclass(frozen=True, eq=False)
class Sheaf:
    """Surface of all keyframes in their own frames.

    points (n, 2), normals (n, 2), spread (n,) metres across the surface, owner (n,) index of the keyframe.
    """

    points: Floats
    normals: Floats
    spread: Floats
    owner: Integers


@dataclass(frozen=True, eq=False)
class Chain:
    """What the wheels say between successive keyframes: moves (k − 1, 3) and their covariances (k − 1, 3, 3)."""

    moves: Floats
    covariances: Floats


def refine(poses: Floats, sheaf: Sheaf, chain: Chain, settings: RefinementSettings) -> Floats:
    """Poses (k, 3) at which all faces agree best; the first one stays."""
    refined = poses.copy()
    if len(sheaf.points) == 0:
        return refined
    for step, cell in enumerate(settings.cells):
        # The grid is shifted each time, so that no wall lies on a border of cells in every round.
        shift = np.array([0.5, 0.25]) * step % 1.0
        refined = _round(refined, sheaf, chain, cell, shift, settings)
    return refined


def _round(
    poses: Floats, sheaf: Sheaf, chain: Chain, cell: float, shift: Floats, settings: RefinementSettings
) -> Floats:
    placed, facing = _placed(sheaf, poses)
    cells, count = _cells(placed, facing, cell, shift, settings.sectors)
    lines = _lines(placed, facing, cells, count, sheaf, settings)
    used = np.flatnonzero(lines.kept[cells])
    cells, owner, spread = cells[used], sheaf.owner[used], sheaf.spread[used]
    normals, off = lines.normals[cells], placed[used] - lines.centres[cells]
    errors = np.einsum("ij,ij->i", off, normals)
    weights = 1 / (1 + (errors / np.maximum(settings.width, 2 * spread)) ** 2)
    root = np.sqrt(weights / settings.shared_beams) / np.maximum(spread, settings.finest)
    arm = placed[used] - poses[owner, :2]
    turn = normals[:, 1] * arm[:, 0] - normals[:, 0] * arm[:, 1]
    rows = root[:, None] * np.column_stack([normals, turn])
    basis = _line_basis(cells, normals[:, 0] * off[:, 1] - normals[:, 1] * off[:, 0], root, count)
    seen = root * errors
    for k in range(2):
        seen = seen - basis[:, k] * np.bincount(cells, basis[:, k] * seen, count)[cells]
    wheels, wheel_errors = _wheel_rows(poses, chain)
    gradient = np.column_stack([np.bincount(owner, rows[:, k] * seen, len(poses)) for k in range(3)]).ravel()
    own = _own_blocks(rows, owner, len(poses)) + wheels.T @ wheels
    through = _through_lines(rows, basis, cells, owner, (2 * count, gradient.size))
    moved = _solve(own, through, gradient + wheels.T @ wheel_errors)
    refined = poses - moved.reshape(-1, 3)
    refined[:, 2] = np.arctan2(np.sin(refined[:, 2]), np.cos(refined[:, 2]))
    return np.asarray(refined)


def _own_blocks(rows: Floats, owner: Integers, count: int) -> csr_array:
    """(3k, 3k) what the points say of each pose if all lines were known: a point belongs to one pose."""
    blocks = np.empty((count, 3, 3))
    for i in range(3):
        for j in range(3):
            blocks[:, i, j] = np.bincount(owner, rows[:, i] * rows[:, j], count)
    places = np.arange(3 * count).reshape(-1, 3)
    columns = np.broadcast_to(places[:, None, :], blocks.shape)
    return csr_array((blocks.ravel(), columns.ravel(), np.arange(0, 9 * count + 1, 3)), shape=(3 * count, 3 * count))


def _through_lines(rows: Floats, basis: Floats, cells: Integers, owner: Integers, shape: tuple[int, int]) -> csr_array:
    """(2c, 3k), its shape: how poses pull at the lines of the cells; what they pull at is no longer known of them."""
    poses = shape[1] // 3
    names, pairs = np.unique(cells * poses + owner, return_inverse=True)
    cell, pose = np.divmod(names, poses)
    values = np.empty((len(names), 2, 3))
    for i in range(2):
        for j in range(3):
            values[:, i, j] = np.bincount(pairs, basis[:, i] * rows[:, j], len(names))
    line = 2 * cell[:, None, None] + np.arange(2)[:, None] + np.zeros((1, 1, 3), np.int64)
    place = 3 * pose[:, None, None] + np.arange(3) + np.zeros((1, 2, 1), np.int64)
    return coo_array((values.ravel(), (line.ravel(), place.ravel())), shape=shape).tocsr()


def _solve(own: csr_array, through: csr_array, gradient: Floats) -> Floats:
    """Conjugate gradients on the reduced equations, which are never formed: hundreds of poses may share a face.

    The chain of the wheels and each pose's own block make the preconditioner; the first pose stays.
    """
    size = len(gradient)
    own = (own + 1e-9 * eye_array(size)).tocsr()[3:, 3:]
    through = through[:, 3:]
    through_t, nearly = through.T.tocsr(), splu(own.tocsc())

    def apply(v: Floats) -> Floats:
        return np.asarray(own @ v - through_t @ (through @ v))

    return np.concatenate([np.zeros(3), _conjugate_gradients(apply, nearly.solve, gradient[3:])])


def _conjugate_gradients(
    apply: Callable[[Floats], Floats], nearly: Callable[[Floats], Floats], right: Floats
) -> Floats:
    """The solution (n,) of apply(x) = right, preconditioned by `nearly`; RefinementError if it does not settle.

    Exact numbers would settle in as many steps as there are unknowns; rounded ones take a few more.
    Sums instead of dot products: those of a threaded BLAS differ from run to run, and its threads cost more than they
    give at this size.
    """
    found, rest = np.zeros_like(right), right.copy()
    nearest = nearly(rest)
    along, product = nearest, float(np.sum(rest * nearest))
    enough = SETTLED**2 * float(np.sum(right * right))
    most = 10 * len(right)
    for _ in range(most + 1):
        if float(np.sum(rest * rest)) <= enough:
            return found
        pulled = apply(along)
        step = product / float(np.sum(along * pulled))
        found, rest = found + step * along, rest - step * pulled
        nearest = nearly(rest)
        product, before = float(np.sum(rest * nearest)), product
        along = nearest + product / before * along
    raise RefinementError(f"the joint refinement of {len(right) // 3 + 1} poses did not settle in {most} steps")


@dataclass(frozen=True, eq=False)
class _Lines:
    """One line per cell: centres (c, 2), normals (c, 2), kept (c,) whether enough keyframes agree on it."""

    centres: Floats
    normals: Floats
    kept: NDArray[np.bool_]


def _placed(sheaf: Sheaf, poses: Floats) -> tuple[Floats, Floats]:
    cosine, sine = np.cos(poses[sheaf.owner, 2]), np.sin(poses[sheaf.owner, 2])

    def turn(vectors: Floats) -> Floats:
        x = cosine * vectors[:, 0] - sine * vectors[:, 1]
        return np.column_stack([x, sine * vectors[:, 0] + cosine * vectors[:, 1]])

    return turn(sheaf.points) + poses[sheaf.owner, :2], turn(sheaf.normals)


def _cells(placed: Floats, facing: Floats, cell: float, shift: Floats, sectors: int) -> tuple[Integers, int]:
    """The cell (n,) of each point, numbered from 0, and how many there are."""
    place = np.floor(placed / cell + shift).astype(np.int64)
    place -= place.min(axis=0)
    sector = (
        np.floor((np.arctan2(facing[:, 1], facing[:, 0]) / (2 * np.pi) + shift[0]) * sectors).astype(np.int64) % sectors
    )
    keys = (place[:, 0] * (place[:, 1].max() + 1) + place[:, 1]) * sectors + sector
    names, cells = np.unique(keys, return_inverse=True)
    return cells.astype(np.int64), len(names)


def _lines(
    placed: Floats, facing: Floats, cells: Integers, count: int, sheaf: Sheaf, settings: RefinementSettings
) -> _Lines:
    """Total least squares in each cell, twice: the second time without the outliers of the first."""
    weights, owner = np.ones(len(placed)), sheaf.owner
    views = np.bincount(np.unique(cells * (owner.max() + 1) + owner) // (owner.max() + 1), minlength=count)
    for _ in range(2):
        total = np.maximum(np.bincount(cells, weights, count), 1e-12)
        centres = np.column_stack([np.bincount(cells, weights * placed[:, k], count) / total for k in range(2)])
        off = placed - centres[cells]
        xx, xy, yy = (
            np.bincount(cells, weights * off[:, i] * off[:, j], count) / total for i, j in ((0, 0), (0, 1), (1, 1))
        )
        angle = 0.5 * np.arctan2(2 * xy, xx - yy)
        normals = np.column_stack([-np.sin(angle), np.cos(angle)])
        across = 0.5 * (xx + yy) - np.sqrt((0.5 * (xx - yy)) ** 2 + xy**2)
        along = xx + yy - across
        errors = np.einsum("ij,ij->i", off, normals[cells])
        weights = 1 / (1 + (errors / np.maximum(settings.width, 2 * sheaf.spread)) ** 2)
    mean_facing = np.column_stack([np.bincount(cells, facing[:, k], count) for k in range(2)])
    mean_facing = mean_facing / np.maximum(np.linalg.norm(mean_facing, axis=1, keepdims=True), 1e-12)
    agree = np.abs(np.einsum("ij,ij->i", mean_facing, normals)) > np.cos(np.pi / settings.sectors * 1.5)
    spread = np.bincount(cells, sheaf.spread, count) / np.bincount(cells, minlength=count)
    thin = (np.sqrt(np.maximum(across, 0)) < np.maximum(settings.thickest, 2 * spread)) & (along > 4 * across)
    return _Lines(centres, normals, (views >= settings.least_views) & thin & agree)


def _line_basis(cells: Integers, along: Floats, root: Floats, count: int) -> Floats:
    """(n, 2) what moving and turning its cell's line does to each point, as columns of length one in each cell."""
    weights = root**2
    total = np.maximum(np.bincount(cells, weights, count), 1e-12)
    centred = along - (np.bincount(cells, weights * along, count) / total)[cells]
    spread = np.maximum(np.bincount(cells, weights * centred**2, count), 1e-12)
    return np.column_stack([root / np.sqrt(total[cells]), root * centred / np.sqrt(spread[cells])])


def _wheel_rows(poses: Floats, chain: Chain) -> tuple[csr_array, Floats]:
    """Whitened rows (3(k − 1), 3k) and errors of the wheels' moves between successive poses."""
    first, second = poses[:-1], poses[1:]
    cosine, sine = np.cos(first[:, 2]), np.sin(first[:, 2])
    x, y = (second - first)[:, 0], (second - first)[:, 1]
    step = np.column_stack([cosine * x + sine * y, -sine * x + cosine * y, second[:, 2] - first[:, 2]])
    errors = step - chain.moves
    errors[:, 2] = np.arctan2(np.sin(errors[:, 2]), np.cos(errors[:, 2]))
    n = len(first)
    back, forth = np.zeros((n, 3, 3)), np.zeros((n, 3, 3))
    forth[:, 0, 0], forth[:, 0, 1], forth[:, 1, 0], forth[:, 1, 1] = cosine, sine, -sine, cosine
    forth[:, 2, 2] = 1
    back[:] = -forth
    back[:, 0, 2], back[:, 1, 2] = step[:, 1], -step[:, 0]
    white = np.linalg.cholesky(np.linalg.inv(chain.covariances)).transpose(0, 2, 1)
    rows = np.concatenate([white @ back, white @ forth], axis=2)
    columns = (3 * np.arange(n)[:, None, None] + np.arange(6)) * np.ones((1, 3, 1), np.int64)
    starts = np.arange(0, 18 * n + 1, 6)
    matrix = csr_array((rows.ravel(), columns.ravel(), starts), shape=(3 * n, 3 * n + 3))
    return matrix, np.einsum("nij,nj->ni", white, errors).ravel()
