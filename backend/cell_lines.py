"""Cell lines: in every small cell and facing sector, the line that the surface samples of many views agree on.

The facing side is part of identity: samples of a thin wall's two faces never share a line.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
SECTORS = 12  # facing directions told apart


@dataclass(frozen=True, eq=False)
class CellGrid:
    """How samples are grouped: cells of `size` metres from `corner` (2,), sectors from `turn` radians."""

    size: float
    corner: Floats
    turn: float


@dataclass(frozen=True, eq=False)
class CellLines:
    """Lines, one per occupied cell and sector.

    group: (n,) line of every sample. centres, normals: (l, 2) of the lines; keys: (l, 3) cell x, cell y, sector.
    residuals: (n,) signed distance of every sample from its line; trust: (n,) its robust weight in 0…1.
    """

    group: Ints
    centres: Floats
    normals: Floats
    keys: Ints
    residuals: Floats
    trust: Floats


def cell_lines(points: Floats, normals: Floats, weight: Floats, scale: Floats, grid: CellGrid) -> CellLines:
    """Robust lines through samples (n, 2) with unit normals, weights (n,) and expected residuals `scale` (n,)."""
    if len(points) == 0:
        nothing = np.empty(0)
        return CellLines(
            np.empty(0, np.int64), np.empty((0, 2)), np.empty((0, 2)), np.empty((0, 3), np.int64), nothing, nothing
        )
    keys, group = _grouped(points, normals, grid)
    count = len(keys)
    facing = _sums(group, normals * weight[:, None], count)
    facing = facing / np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-12)
    offset = np.sum(points * facing[group], axis=1)
    level = _weighted_medians(group, offset, weight)
    for _ in range(3):
        residuals = offset - level[group]
        trust = 1 / (1 + (residuals / scale) ** 2)
        total = np.maximum(np.bincount(group, weight * trust, count), 1e-12)
        level = np.bincount(group, weight * trust * offset, count) / total
    residuals = offset - level[group]
    centres = _sums(group, points * (weight * trust)[:, None], count) / total[:, None]
    centres = centres + (level - np.sum(centres * facing, axis=1))[:, None] * facing
    return CellLines(group, centres, facing, keys, residuals, 1 / (1 + (residuals / scale) ** 2))


def distinct_views(group: Ints, view: Ints, count: int) -> Ints:
    """How many different views have a sample in each of `count` groups."""
    pairs = np.unique(group * (int(view.max(initial=0)) + 1) + view)
    return np.bincount(pairs // (int(view.max(initial=0)) + 1), minlength=count)


def _grouped(points: Floats, normals: Floats, grid: CellGrid) -> tuple[Ints, Ints]:
    """Keys (l, 3) of the occupied cells and sectors, and the group (n,) of every sample."""
    cell = np.floor((points - grid.corner) / grid.size).astype(np.int64)
    angle = np.arctan2(normals[:, 1], normals[:, 0]) - grid.turn
    sector = np.floor(angle / (2 * np.pi) * SECTORS).astype(np.int64) % SECTORS
    low = cell.min(axis=0)
    height = cell[:, 1].max() - low[1] + 1
    code = ((cell[:, 0] - low[0]) * height + cell[:, 1] - low[1]) * SECTORS + sector
    present, group = np.unique(code, return_inverse=True)
    column, row = np.divmod(present // SECTORS, height)
    return np.stack([column + low[0], row + low[1], present % SECTORS], axis=1), group


def _sums(group: Ints, values: Floats, count: int) -> Floats:
    return np.stack([np.bincount(group, values[:, 0], count), np.bincount(group, values[:, 1], count)], axis=1)


def _weighted_medians(group: Ints, values: Floats, weight: Floats) -> Floats:
    """The weighted median of the values in every group: a start that two parallel surfaces do not average away."""
    order = np.lexsort((values, group))
    heap = np.cumsum(weight[order])
    last = np.append(np.flatnonzero(np.diff(group[order])), len(group) - 1)
    before = np.concatenate([[0.0], heap[last[:-1]]])
    middle = np.searchsorted(heap, 0.5 * (before + heap[last]))
    return np.asarray(values[order[np.minimum(middle, last)]])
