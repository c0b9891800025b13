"""The main map: of frames that were never joined, the one with the most scans; the others are left out."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from backend.estimate import Decision, LandmarkTie
from backend.factor_graph import FactorGraph
from frontend.scan import Booleans, Floats, Integers


def main_root(roots: Integers) -> int:
    """The root of most scans, whose roots are given (n,); the earliest of equals."""
    found, counts = np.unique(roots, return_counts=True)
    return int(found[np.argmax(counts)]) if len(found) else 0


def left_out(roots: Integers, main: int) -> list[Decision]:
    """One decision for each frame of scans (n,) that was never joined to the main one."""
    return [
        Decision("session", tuple(map(int, scans)), accepted=False, reason=reason)
        for root in np.unique(roots[roots != main])
        for scans in [np.flatnonzero(roots == root)]
        for reason in [f"none of its {len(scans)} scans was recognised in the map: they are left out of it"]
    ]


def landmarks_in(graph: FactorGraph, inside: Booleans) -> tuple[Floats, tuple[LandmarkTie, ...]]:
    """Landmarks (m, 2) seen from the poses inside (k,), and their ties by the places they have here."""
    kept = np.ones(len(graph.landmarks), np.bool_)
    for tie in graph.landmark_ties:
        kept[tie.landmark] &= inside[tie.pose]
    places = np.cumsum(kept) - 1
    return graph.landmarks[kept], _renumbered(graph.landmark_ties, kept, places)


def _renumbered(ties: Sequence[LandmarkTie], kept: Booleans, places: Integers) -> tuple[LandmarkTie, ...]:
    return tuple(replace(tie, landmark=int(places[tie.landmark])) for tie in ties if kept[tie.landmark])
