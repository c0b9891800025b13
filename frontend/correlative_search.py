"""Correlative search: the best pose of a scan over a whole window, found by branch and bound."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frontend.compiled import compiled
from frontend.scan import Floats, Integers

Scores = NDArray[np.float32]
Pyramid = NDArray[np.float32]


@dataclass(frozen=True)
class SearchSettings:
    """How finely the window is searched."""

    cell: float = 0.05  # metres; larger is faster and coarser
    blur: float = 0.08  # metres, standard deviation of the score around a map point; larger is more forgiving
    levels: int = 6  # halvings from the coarsest to the finest step; more suits wider windows


@dataclass(frozen=True, eq=False)
class Found:
    """The best pose (3,) of the window and its score in 0…1 (1: every point lies on the map)."""

    pose: Floats
    score: float


@dataclass(frozen=True, eq=False)
class ScoreGrid:
    """How near each cell is to the map, with the maxima over 1, 2, 4 … cells that bound the search: (levels, w, h)."""

    pyramid: Pyramid
    corner: Floats
    cell: float

    @classmethod
    def of(cls, map_points: Floats, settings: SearchSettings) -> "ScoreGrid":
        """Prepare the grid of map points (k, 2)."""
        margin = 4 * settings.blur
        corner = map_points.min(axis=0) - margin
        width, height = np.ceil((map_points.max(axis=0) + margin - corner) / settings.cell).astype(int) + 1
        score = np.zeros((width, height), np.float32)
        _stamp(map_points, corner, settings.cell, settings.blur, score)
        return cls(_maxima(score, settings.levels), corner, settings.cell)

    def search(self, points: Floats, guess: Floats, window: tuple[float, float], least: float) -> Found | None:
        """The best pose of points (k, 2) within `window` (metres, radians) of `guess`, if it scores over `least`."""
        reach = float(np.linalg.norm(points, axis=1).max())
        step = self.cell / max(reach, 1.0)
        turns = guess[2] + step * np.arange(-np.ceil(window[1] / step), np.ceil(window[1] / step) + 1)
        span = int(np.ceil(window[0] / self.cell - 1e-6))
        cells = _turned_cells(points, turns, guess[:2] - self.corner, self.cell)
        score, k, u, v = _best(self.pyramid, cells, span, least * len(points))
        if k < 0:
            return None
        pose = np.array([guess[0] + u * self.cell, guess[1] + v * self.cell, turns[k]])
        return Found(pose, float(score) / len(points))


@compiled
def _turned_cells(points: Floats, turns: Floats, offset: Floats, cell: float) -> Integers:
    """Cells (t, k, 2) of the points (k, 2) at each of the turns (t,), seen from the grid's corner."""
    cells = np.empty((len(turns), len(points), 2), np.int64)
    for t in range(len(turns)):
        cosine, sine = np.cos(turns[t]), np.sin(turns[t])
        for k in range(len(points)):
            cells[t, k, 0] = int(np.floor((cosine * points[k, 0] - sine * points[k, 1] + offset[0]) / cell))
            cells[t, k, 1] = int(np.floor((sine * points[k, 0] + cosine * points[k, 1] + offset[1]) / cell))
    return cells


@compiled
def _stamp(points: Floats, corner: Floats, cell: float, blur: float, score: Scores) -> None:
    """Raise the score (w, h) around each point to that of a bell, the product of one along x and one along y."""
    reach = int(np.ceil(2.5 * blur / cell))
    narrow, along_y = -0.5 * (cell / blur) ** 2, np.empty(2 * reach + 1, np.float32)
    for i in range(len(points)):
        x, y = (points[i, 0] - corner[0]) / cell, (points[i, 1] - corner[1]) / cell
        u, v = int(x) - reach, int(y) - reach
        for b in range(2 * reach + 1):
            along_y[b] = np.exp(narrow * (v + b + 0.5 - y) ** 2)
        for a in range(max(0, u), min(score.shape[0], u + 2 * reach + 1)):
            along_x = np.float32(np.exp(narrow * (a + 0.5 - x) ** 2))
            for b in range(max(0, -v), min(score.shape[1] - v, 2 * reach + 1)):
                score[a, v + b] = max(score[a, v + b], along_x * along_y[b])


@compiled
def _maxima(score: Scores, levels: int) -> Pyramid:
    """Level h holds at each cell the maximum over the 2^h × 2^h cells from it on; padded below for all shifts."""
    pad = 1 << (levels - 1)
    width, height = score.shape[0] + pad, score.shape[1] + pad
    pyramid = np.zeros((levels, width, height), np.float32)
    pyramid[0, pad:, pad:] = score
    for h in range(1, levels):
        d = 1 << (h - 1)
        for a in range(width):
            row, other = pyramid[h - 1, a], pyramid[h - 1, min(a + d, width - 1)]
            for b in range(height):
                pyramid[h, a, b] = max(row[b], other[b]) if a + d < width else row[b]
            # In rising order, so that what lies ahead has not been raised by what lies beyond it.
            for b in range(height - d):
                pyramid[h, a, b] = max(pyramid[h, a, b], pyramid[h, a, b + d])
    return pyramid


@compiled
def _bound(level: Scores, cells: Integers, u: int, v: int, pad: int) -> np.float32:
    total = np.float32(0.0)
    for i in range(len(cells)):
        a, b = cells[i, 0] + u + pad, cells[i, 1] + v + pad
        if 0 <= a < level.shape[0] and 0 <= b < level.shape[1]:
            total += level[a, b]
    return total


@compiled
def _best(pyramid: Pyramid, cells: Integers, span: int, least: float) -> tuple[np.float32, int, int, int]:
    """Depth first with the best bounds first; returns score, turn, shift in cells (turn −1: nothing over `least`)."""
    levels = len(pyramid)
    pad = 1 << (levels - 1)
    stride = pad
    count = (2 * span) // stride + 1
    total = len(cells) * count * count
    roots = np.empty((total, 3), np.int64)
    bounds = np.empty(total, np.float32)
    n = 0
    for k in range(len(cells)):
        for p in range(count):
            for q in range(count):
                u, v = -span + p * stride, -span + q * stride
                roots[n] = k, u, v
                bounds[n] = _bound(pyramid[levels - 1], cells[k], u, v, pad)
                n += 1
    best, best_k, best_u, best_v = np.float32(least), -1, 0, 0
    stack = np.empty((4 * levels + 4, 4), np.int64)
    limits = np.empty(4 * levels + 4, np.float32)
    for r in np.argsort(-bounds):
        if bounds[r] <= best:
            break
        top = 1
        stack[0] = levels - 1, roots[r, 0], roots[r, 1], roots[r, 2]
        limits[0] = bounds[r]
        while top > 0:
            top -= 1
            h, k, u, v = stack[top]
            if limits[top] <= best:
                continue
            if h == 0:
                best, best_k, best_u, best_v = limits[top], k, u, v
                continue
            d = 1 << (h - 1)
            children = np.empty(4, np.float32)
            for c in range(4):
                children[c] = _bound(pyramid[h - 1], cells[k], u + d * (c // 2), v + d * (c % 2), pad)
            for c in np.argsort(children):
                inside = u + d * (c // 2) <= span and v + d * (c % 2) <= span
                if inside and children[c] > best:
                    stack[top] = h - 1, k, u + d * (c // 2), v + d * (c % 2)
                    limits[top] = children[c]
                    top += 1
    return best, best_k, best_u, best_v
