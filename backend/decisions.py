"""Decisions: what became of every piece of every view's boundary, and which views decided it (Flynn 1988, §4.1).

Real pieces are kept or contradicted; fake ones were seen behind by another view, or stay open.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import overload

import numpy as np
import shapely
from numpy.typing import NDArray

from backend.room_map import Decision, MapEdge, Verdict
from backend.sight import Sight

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Decisions(Sequence[Decision]):
    """The decisions of a map, worked out when somebody first looks at them."""

    def __init__(self, decide: Callable[[], tuple[Decision, ...]]) -> None:
        self._decide = decide

    @cached_property
    def _made(self) -> tuple[Decision, ...]:
        return self._decide()

    @overload
    def __getitem__(self, index: int) -> Decision: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Decision, ...]: ...
    def __getitem__(self, index: int | slice) -> Decision | tuple[Decision, ...]:
        return self._made[index]

    def __len__(self) -> int:
        return len(self._made)

    def __iter__(self) -> Iterator[Decision]:
        return iter(self._made)


def decisions_of(
    rings: list[Floats],
    reals: list[NDArray[np.bool_]],
    inside: list[NDArray[np.bool_]],
    sight: Sight,
    edges: tuple[MapEdge, ...],
) -> tuple[Decision, ...]:
    """Runs of each placed ring (m, 2) with one verdict; `inside` (m,): the edge lies deep in the final free space."""
    runs = [_runs(real, deep) for real, deep in zip(reals, inside, strict=True)]
    owner = np.repeat(np.arange(len(rings)), [len(starts) for starts, _, _ in runs])
    starts, lengths, verdicts = (np.concatenate([run[i] for run in runs]) for i in range(3))
    pieces = [
        rings[o].take(np.arange(s, s + n + 1), axis=0, mode="wrap")
        for o, s, n in zip(owner, starts, lengths, strict=True)
    ]
    middles = np.array([_middle(piece) for piece in pieces]).reshape(-1, 2)
    overruled = (verdicts == Verdict.CONTRADICTED) | (verdicts == Verdict.SEEN_BEHIND)
    seers = _seers(middles, owner, overruled, sight)
    keepers = _keepers(middles, verdicts == Verdict.KEPT, edges)
    return tuple(
        Decision(
            Verdict(int(verdict)), piece, np.array([view]), seers.get(i, keepers.get(i, np.empty(0, dtype=np.int64)))
        )
        for i, (verdict, piece, view) in enumerate(zip(verdicts, pieces, owner, strict=True))
    )


def _runs(real: NDArray[np.bool_], inside: NDArray[np.bool_]) -> tuple[Ints, Ints, Ints]:
    """First edge, number of edges and verdict of every run of equal verdicts along a ring."""
    verdict = np.select(
        [real & ~inside, real & inside, ~real & inside],
        [int(Verdict.KEPT), int(Verdict.CONTRADICTED), int(Verdict.SEEN_BEHIND)],
        int(Verdict.OPEN),
    )
    starts = np.flatnonzero(verdict != np.roll(verdict, 1))
    starts = starts if len(starts) else np.zeros(1, dtype=np.int64)
    lengths = np.diff(np.append(starts, starts[0] + len(verdict)))
    return starts, lengths, verdict[starts]


def _middle(piece: Floats) -> Floats:
    return np.asarray(0.5 * (piece[(len(piece) - 1) // 2] + piece[len(piece) // 2]))


def _seers(middles: Floats, owner: Ints, overruled: NDArray[np.bool_], sight: Sight) -> dict[int, Ints]:
    """For every overruled piece, the other views that held its middle for free."""
    which = np.flatnonzero(overruled)
    point, view = sight.pairs(middles[which])
    other = view != owner[which[point]]
    point, view = point[other], view[other]
    parts = np.split(view, np.searchsorted(point, np.arange(1, len(which))))
    return dict(zip(which.tolist(), parts, strict=False))


def _keepers(middles: Floats, kept: NDArray[np.bool_], edges: tuple[MapEdge, ...]) -> dict[int, Ints]:
    """For every kept piece, the views that support the map's edge nearest to it."""
    which = np.flatnonzero(kept)
    if not edges or not len(which):
        return {}
    tree = shapely.STRtree([shapely.LineString([edge.start, edge.end]) for edge in edges])
    nearest = np.atleast_1d(tree.nearest([shapely.Point(middle) for middle in middles[which]]))
    return {int(i): edges[int(edge)].views for i, edge in zip(which, nearest, strict=True)}
