"""Samples along edges: which measured points lie by which edge of the map and face its free side."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from backend.samples import Samples

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
CELL = 0.25  # metres of the raster that finds edges; larger takes less memory and longer


class Along(NamedTuple):
    """Pairs (p,) of an edge and a sample beside it, by edge and, along it, in rising order; metres along and off it."""

    edge: Ints
    sample: Ints
    along: Floats
    off: Floats


def along_edges(edges: Floats, samples: Samples, reach: float) -> Along:
    """Pairs of edges (e, 2, 2), free on their left, and samples within `reach` ≤ CELL / 2 metres facing that side."""
    if not len(edges) or not len(samples.view):
        return Along(np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0), np.empty(0))
    low = edges.min(axis=(0, 1)) - 2 * CELL
    columns, rows = np.ceil((edges.max(axis=(0, 1)) + 2 * CELL - low) / CELL).astype(np.int64)
    raster = _raster(edges, low, columns, rows)
    edge, sample, along, off = _pairs(edges, samples.points, samples.normals, (*raster, low, columns, rows), reach)
    order = np.lexsort((along, edge))
    return Along(edge[order], sample[order], along[order], off[order])


@njit(cache=True)
def _raster(edges, low, columns, rows):  # type: ignore[no-untyped-def]
    """Edges by cell, each listed in all cells on its way and beside these: (starts of the cells, edges)."""
    starts = np.zeros(columns * rows + 1, dtype=np.int64)
    for filling in (False, True):
        last = np.full(columns * rows, -1, dtype=np.int64)
        if filling:
            starts = np.cumsum(starts)
            listed, filled = np.empty(starts[-1], dtype=np.int64), starts[:-1].copy()
        for edge in range(len(edges)):
            dx, dy = edges[edge, 1] - edges[edge, 0]
            steps = int(2 * np.sqrt(dx * dx + dy * dy) / CELL) + 1
            for step in range(steps + 1):
                column = int((edges[edge, 0, 0] + step / steps * dx - low[0]) / CELL)
                row = int((edges[edge, 0, 1] + step / steps * dy - low[1]) / CELL)
                for around in range(9):
                    cell = (row + around // 3 - 1) * columns + column + around % 3 - 1
                    if last[cell] == edge:
                        continue
                    last[cell] = edge
                    if filling:
                        listed[filled[cell]] = edge
                        filled[cell] += 1
                    else:
                        starts[cell + 1] += 1
    return starts, listed


@njit(cache=True)
def _pairs(edges, points, normals, raster, reach):  # type: ignore[no-untyped-def]
    starts, listed, low, columns, rows = raster
    count = 0
    numbers, metres = np.empty((2, len(points) + 64), dtype=np.int64), np.empty((2, len(points) + 64))
    for point in range(len(points)):
        column, row = (points[point] - low) // CELL
        if not (0 <= column < columns and 0 <= row < rows):
            continue
        cell = int(row) * columns + int(column)
        for edge in listed[starts[cell] : starts[cell + 1]]:
            dx, dy = edges[edge, 1] - edges[edge, 0]
            length = max(np.sqrt(dx * dx + dy * dy), 1e-9)
            ux, uy = dx / length, dy / length
            x, y = points[point] - edges[edge, 0]
            along, off = min(max(x * ux + y * uy, 0.0), length), y * ux - x * uy
            away = (x - along * ux) ** 2 + (y - along * uy) ** 2
            if away > reach**2 or normals[point, 1] * ux - normals[point, 0] * uy <= 0.5:
                continue
            if count == numbers.shape[1]:
                numbers = np.concatenate((numbers, np.empty_like(numbers)), axis=1)
                metres = np.concatenate((metres, np.empty_like(metres)), axis=1)
            numbers[0, count], numbers[1, count] = edge, point
            metres[0, count], metres[1, count] = along, off
            count += 1
    return numbers[0, :count], numbers[1, :count], metres[0, :count], metres[1, :count]
