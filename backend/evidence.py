"""One-sided evidence: each view votes free inside its polygon and wall in a strip behind its real edges.

Votes are whole numbers on square cells kept in sparse tiles, so a view can be taken back exactly and
the order of views cannot matter. Nothing is voted at fake edges: what lies behind them is unknown.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
TILE = 128  # cells along the side of one tile


@dataclass(frozen=True, eq=False)
class Ballot:
    """What one placed view votes: closed rings stacked on each other, in cells.

    free: (m, 2) ring of the free polygon. walls: (4 s, 2) corners of the convex strips behind real edges, four each.
    """

    free: Floats
    walls: Floats


@dataclass(frozen=True, eq=False)
class Counts:
    """A dense window of the votes: rows upward from `corner` (2,) in cells; free and wall (rows, columns)."""

    free: NDArray[np.int16]
    wall: NDArray[np.int16]
    corner: Ints
    cell: float

    def at(self, points: Floats) -> tuple[NDArray[np.int16], NDArray[np.int16]]:
        """Free and wall votes at points (n, 2) in metres; zero outside the window."""
        column, row = (np.floor(points / self.cell).astype(np.int64) - self.corner).T
        rows, columns = self.free.shape
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        row, column = np.where(inside, row, 0), np.where(inside, column, 0)
        return np.where(inside, self.free[row, column], 0), np.where(inside, self.wall[row, column], 0)


class EvidenceGrid:
    """Votes for free and wall, tile by tile; memory follows the ground that was seen."""

    def __init__(self, cell: float) -> None:
        self.cell = cell
        self._first_tile = np.zeros(2, dtype=np.int64)  # tile coordinates of _tiles[0, 0]
        self._tiles = np.full((0, 0), -1, dtype=np.int64)  # (rows, columns) of tile numbers, -1: not yet there
        self._votes = np.zeros((0, 2, TILE, TILE), dtype=np.int16)
        self._used = 0

    @property
    def bytes(self) -> int:
        """Memory the votes take."""
        return self._votes.nbytes + self._tiles.nbytes

    def cast(self, ballot: Ballot, sign: int) -> None:
        """Add (sign 1) or take back (sign −1) the votes of one view."""
        corners = np.vstack([ballot.free, ballot.walls])
        self._reach(np.floor(corners.min(axis=0)).astype(np.int64), np.ceil(corners.max(axis=0)).astype(np.int64))
        ends = len(ballot.free) + np.arange(0, len(ballot.walls) + 1, 4)
        _vote(corners, ends, (self._tiles, self._first_tile), self._votes, sign)

    def counts(self) -> Counts:
        """All votes as one dense window with an empty rim of one tile."""
        rows, columns = self._tiles.shape
        window = np.zeros((2, rows + 2, TILE, columns + 2, TILE), dtype=np.int16)
        for row, column in np.argwhere(self._tiles >= 0):
            window[:, row + 1, :, column + 1, :] = self._votes[self._tiles[row, column]]
        free, wall = window.reshape(2, (rows + 2) * TILE, (columns + 2) * TILE)
        return Counts(free, wall, (self._first_tile - 1) * TILE, self.cell)

    def _reach(self, low: Ints, high: Ints) -> None:
        """Make sure that every tile between two cells (2,) exists."""
        first, last = low // TILE, high // TILE
        if self._tiles.size == 0:
            self._first_tile = first
        new_first = np.minimum(first, self._first_tile)
        new_last = np.maximum(last, self._first_tile + self._tiles.shape[::-1] - 1)
        if np.any(new_first < self._first_tile) or np.any((new_last - new_first + 1)[::-1] > self._tiles.shape):
            grown = np.full((new_last - new_first + 1)[::-1], -1, dtype=np.int64)
            column, row = self._first_tile - new_first
            grown[row : row + self._tiles.shape[0], column : column + self._tiles.shape[1]] = self._tiles
            self._tiles, self._first_tile = grown, new_first
        (column, row), (last_column, last_row) = first - self._first_tile, last - self._first_tile + 1
        wanted = self._tiles[row:last_row, column:last_column]
        missing = wanted < 0
        wanted[missing] = self._used + np.arange(np.count_nonzero(missing))
        self._used += int(np.count_nonzero(missing))
        if self._used > len(self._votes):
            spare = np.zeros((self._used + self._used // 4 - len(self._votes), 2, TILE, TILE), dtype=np.int16)
            self._votes = np.concatenate([self._votes, spare])


@njit(cache=True)
def _vote(corners, ends, ground, votes, sign):  # type: ignore[no-untyped-def]
    """Fill ring 0 into the free votes and every other ring, of four corners, into the wall votes."""
    _fill(corners[: ends[0]], ground, votes[:, 0], sign)
    for ring in range(1, len(ends)):
        _fill_strip(corners[ends[ring - 1] : ends[ring]], ground, votes[:, 1], sign)


@njit(cache=True)
def _fill(ring, ground, votes, sign):  # type: ignore[no-untyped-def]
    """Even-odd scan conversion: a cell belongs to the ring if its centre does."""
    low = int(np.ceil(ring[:, 1].min() - 0.5))
    high = int(np.ceil(ring[:, 1].max() - 0.5))  # rows low … high − 1 have their centre line inside
    if high <= low:
        return
    crossings, starts = _crossings(ring, low, high)
    for row in range(low, high):
        line = np.sort(crossings[starts[row - low] : starts[row - low + 1]])
        for pair in range(0, len(line) - 1, 2):
            _fill_row(row, line[pair], line[pair + 1], ground, votes, sign)


@njit(cache=True)
def _fill_strip(strip, ground, votes, sign):  # type: ignore[no-untyped-def]
    """The same for four corners, without any list."""
    low = int(np.ceil(strip[:, 1].min() - 0.5))
    high = int(np.ceil(strip[:, 1].max() - 0.5))
    for row in range(low, high):
        left, right = np.inf, -np.inf
        for i in range(4):
            x0, y0 = strip[i]
            x1, y1 = strip[(i + 1) % 4]
            if (y0 <= row + 0.5) != (y1 <= row + 0.5):
                x = x0 + (row + 0.5 - y0) * (x1 - x0) / (y1 - y0)
                left, right = min(left, x), max(right, x)
        if left < right:
            _fill_row(row, left, right, ground, votes, sign)


@njit(cache=True)
def _fill_row(row, left, right, ground, votes, sign):  # type: ignore[no-untyped-def]
    """Vote in the cells of one row whose centres lie between `left` and `right`, tile by tile."""
    tiles, first_tile = ground
    tile_row, in_row = row // TILE - first_tile[1], row % TILE
    column, last = int(np.ceil(left - 0.5)), int(np.ceil(right - 0.5))
    while column < last:
        end = min(last, (column // TILE + 1) * TILE)
        cells = votes[tiles[tile_row, column // TILE - first_tile[0]], in_row]
        start = column % TILE
        for cell in range(start, start + end - column):
            cells[cell] += sign
        column = end


@njit(cache=True)
def _crossings(ring, low, high):  # type: ignore[no-untyped-def]
    """Where the ring crosses each row's centre line, grouped by row: (crossings, starts)."""
    starts = np.zeros(high - low + 1, dtype=np.int64)
    spans = np.empty((len(ring), 2), dtype=np.int64)
    for i in range(len(ring)):
        y0, y1 = ring[i, 1], ring[(i + 1) % len(ring), 1]
        spans[i, 0] = int(np.ceil(min(y0, y1) - 0.5))
        spans[i, 1] = int(np.ceil(max(y0, y1) - 0.5))
        for row in range(spans[i, 0], spans[i, 1]):
            starts[row - low + 1] += 1
    starts = np.cumsum(starts)
    crossings = np.empty(starts[-1])
    filled = starts[:-1].copy()
    for i in range(len(ring)):
        x0, y0 = ring[i]
        x1, y1 = ring[(i + 1) % len(ring)]
        for row in range(spans[i, 0], spans[i, 1]):
            crossings[filled[row - low]] = x0 + (row + 0.5 - y0) * (x1 - x0) / (y1 - y0)
            filled[row - low] += 1
    return crossings, starts
