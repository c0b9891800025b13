"""The room map: free space whose every edge says who saw it and how surely."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from shapely import MultiPolygon, Polygon

Floats = NDArray[np.float64]


class MapEdgeKind(IntEnum):
    """Whether an edge of the map was confirmed as surface."""

    REAL = 0
    FRONTIER = 1


@dataclass(frozen=True, eq=False)
class MapEdge:
    """One edge of the map's boundary, free space on its left.

    support: how many views measured it; contradictions: how many saw through it;
    views: (k,) indices of the supporting views; spread: standard deviation across the edge, metres.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    kind: MapEdgeKind
    support: int
    contradictions: int
    spread: float
    views: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Door:
    """An opening between two jambs. confidence in 0…1; views that saw it."""

    name: str
    jambs: Floats  # (2, 2)
    confidence: float
    views: NDArray[np.int64]

    @property
    def width(self) -> float:
        """Distance between the jambs, metres."""
        return float(np.linalg.norm(self.jambs[1] - self.jambs[0]))


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A closed object inside the room: measured (it has real edges) or inferred (only enclosed by views)."""

    outline: Polygon
    inferred: bool
    support: int
    views: NDArray[np.int64]


class Verdict(IntEnum):
    """What the merge did with a piece of a view's boundary (Flynn 1988, §4.1)."""

    KEPT = 0  # real, and part of the map's boundary
    CONTRADICTED = 1  # real in its view, but others saw through it
    SEEN_BEHIND = 2  # fake: another view saw what lies behind it
    OPEN = 3  # fake, and nobody saw behind it: a frontier
    INFERRED = 4  # an object nobody saw whole, closed by its surroundings


@dataclass(frozen=True, eq=False)
class Decision:
    """One decision of the merge: the piece (k, 2) it is about, whose it was, and the views that decided it."""

    verdict: Verdict
    piece: Floats
    owners: NDArray[np.int64]
    deciders: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RoomMap:
    """The merged map, in metres, in the frame of the first pose.

    free: the best estimate of free space. safety: the same, inset for planning.
    leaks: (l, 2) points of supported real edges that lie inside the final free space (the wall-leak alarm).
    leak_reasons: for each of them, why the merge let it go.
    decisions: what was kept, thrown away and inferred, and by whom.
    """

    free: MultiPolygon
    safety: MultiPolygon
    edges: tuple[MapEdge, ...]
    doors: tuple[Door, ...]
    obstacles: tuple[Obstacle, ...]
    leaks: Floats
    decisions: Sequence[Decision] = ()
    leak_reasons: tuple[str, ...] = ()
