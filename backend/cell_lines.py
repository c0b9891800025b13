"""Cell lines: in every small cell and facing sector, the line that the surface samples of many views agree on.

The facing side is part of identity: samples of a thin wall's two faces never share a line.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
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

    group: (n,) line of every sample. order, starts: samples line by line, in their own order, and (l + 1,) where each
    line's begin. centres, normals: (l, 2) of the lines; keys: (l, 3) cell x, cell y, sector, in rising order.
    residuals: (n,) signed distance of every sample from its line; trust: (n,) its robust weight in 0…1.
    """

    group: Ints
    order: Ints
    starts: Ints
    centres: Floats
    normals: Floats
    keys: Ints
    residuals: Floats
    trust: Floats


def cell_lines(points: Floats, normals: Floats, weight: Floats, scale: Floats, grid: CellGrid) -> CellLines:
    """Robust lines through samples (n, 2) with unit normals, weights (n,) and expected residuals `scale` (n,)."""
    keys, group = _grouped(points, normals, grid)
    order, starts = in_groups(group, len(keys))
    centres, facing, residuals = _fitted((order, starts), points, normals, weight, scale)
    return CellLines(group, order, starts, centres, facing, keys, residuals, 1 / (1 + (residuals / scale) ** 2))


def distinct_views(group: Ints, view: Ints, count: int) -> Ints:
    """How many different views have a sample in each of `count` groups; samples in rising order of view."""
    order, starts = in_groups(group, count)
    return np.asarray(_changes(view[order], starts))


@njit(cache=True)
def in_groups(group, count):  # type: ignore[no-untyped-def]
    """Members (n,) group by group, in their own order, and (count + 1,) where each group's begin."""
    starts = np.zeros(count + 1, dtype=np.int64)
    for number in group:
        starts[number + 1] += 1
    starts = np.cumsum(starts)
    filled, order = starts[:-1].copy(), np.empty(len(group), dtype=np.int64)
    for i in range(len(group)):
        order[filled[group[i]]] = i
        filled[group[i]] += 1
    return order, starts


def _grouped(points: Floats, normals: Floats, grid: CellGrid) -> tuple[Ints, Ints]:
    """Keys (l, 3) of the occupied cells and sectors, and the group (n,) of every sample."""
    cell = np.floor((points - grid.corner) / grid.size).astype(np.int64)
    angle = np.arctan2(normals[:, 1], normals[:, 0]) - grid.turn
    sector = np.floor(angle / (2 * np.pi) * SECTORS).astype(np.int64) % SECTORS
    low = cell.min(axis=0, initial=np.iinfo(np.int64).max)
    height = cell[:, 1].max(initial=low[1]) - low[1] + 1
    group, codes = numbered(((cell[:, 0] - low[0]) * height + cell[:, 1] - low[1]) * SECTORS + sector)
    rising = np.argsort(codes)
    rank = np.empty(len(codes), dtype=np.int64)
    rank[rising] = np.arange(len(codes))
    column, row = np.divmod(codes[rising] // SECTORS, height)
    return np.stack([column + low[0], row + low[1], codes[rising] % SECTORS], axis=1), rank[group]


@njit(cache=True)
def numbered(codes):  # type: ignore[no-untyped-def]
    """Number (n,) of every code in the order of first sight, and the codes so numbered: a table with open addresses."""
    size = 16
    while size < 2 * len(codes):
        size *= 2
    table = np.full(size, -1, dtype=np.int64)
    number, known = np.empty(len(codes), dtype=np.int64), np.empty(len(codes), dtype=np.int64)
    count = 0
    for i in range(len(codes)):
        place = (codes[i] * 0x9E3779B97F4A7C1 >> 20) & (size - 1)
        while table[place] >= 0 and known[table[place]] != codes[i]:
            place = (place + 1) & (size - 1)
        if table[place] < 0:
            table[place] = count
            known[count] = codes[i]
            count += 1
        number[i] = table[place]
    return number, known[:count].copy()


@njit(cache=True)
def _changes(view, starts):  # type: ignore[no-untyped-def]
    """How many views every group has, its members in rising order of view."""
    count = np.zeros(len(starts) - 1, dtype=np.int64)
    for group in range(len(count)):
        for i in range(starts[group], starts[group + 1]):
            if i == starts[group] or view[i] != view[i - 1]:
                count[group] += 1
    return count


@njit(cache=True)
def _fitted(groups, points, normals, weight, scale):  # type: ignore[no-untyped-def]
    """Centre and normal of every line, and the samples' distances from theirs: three rounds of Cauchy's weights."""
    order, starts = groups
    centres, facing = np.zeros((len(starts) - 1, 2)), np.zeros((len(starts) - 1, 2))
    residuals = np.empty(len(order))
    for line in range(len(centres)):
        own = order[starts[line] : starts[line + 1]]
        nx, ny = (weight[own] * normals[own, 0]).sum(), (weight[own] * normals[own, 1]).sum()
        length = max(np.sqrt(nx * nx + ny * ny), 1e-12)
        nx, ny = nx / length, ny / length
        offset, weights, scales = points[own, 0] * nx + points[own, 1] * ny, weight[own], scale[own]
        level, trusted = _level(offset, weights, scales)
        total = max(trusted.sum(), 1e-12)
        x, y = (trusted * points[own, 0]).sum() / total, (trusted * points[own, 1]).sum() / total
        away = level - (x * nx + y * ny)
        centres[line, 0], centres[line, 1] = x + away * nx, y + away * ny
        facing[line, 0], facing[line, 1] = nx, ny
        residuals[own] = offset - level
    return centres, facing, residuals


@njit(cache=True)
def _level(offset, weight, scale):  # type: ignore[no-untyped-def]
    """The robust mean of offsets, and the weights (n,) it was taken with last."""
    level, trusted = _weighted_median(offset, weight), np.empty_like(weight)
    for _ in range(3):
        total = mean = 0.0
        for i in range(len(offset)):
            trusted[i] = weight[i] / (1 + ((offset[i] - level) / scale[i]) ** 2)
            total += trusted[i]
            mean += trusted[i] * offset[i]
        level = mean / max(total, 1e-12)
    return level, trusted


@njit(cache=True)
def _weighted_median(values, weight):  # type: ignore[no-untyped-def]
    """A start that two parallel surfaces do not average away."""
    order = np.argsort(values)
    half, heap = 0.5 * weight.sum(), 0.0
    for i in order:
        heap += weight[i]
        if heap >= half:
            return values[i]
    return values[order[-1]]
