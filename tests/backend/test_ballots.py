"""Claims about what a view votes."""

import numpy as np

from backend.ballots import ballot_of
from backend.evidence import EvidenceGrid

RING = np.array([[2.0, -1.0], [2.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])


def test_walls_are_voted_behind_real_edges_only_and_never_inside() -> None:
    grid = EvidenceGrid(0.02)
    grid.cast(ballot_of(RING, np.array([True, False, False, False]), np.zeros(2), 0.06, 0.02), 1)
    counts = grid.counts()
    assert not np.any((counts.free > 0) & (counts.wall > 0))
    free, wall = counts.at(np.array([[1.99, 0.0], [2.03, 0.0], [2.09, 0.0], [0.0, 1.03], [-1.03, 0.0]]))
    assert free.tolist() == [1, 0, 0, 0, 0]
    assert wall.tolist() == [0, 1, 0, 0, 0]


def test_a_view_has_one_vote_per_cell_even_where_its_strips_meet() -> None:
    grid = EvidenceGrid(0.02)
    angles = np.linspace(-np.pi, np.pi, 90, endpoint=False)
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    grid.cast(ballot_of(ring, np.ones(90, dtype=bool), np.array([0.2, 0.1]), 0.06, 0.02), 1)
    counts = grid.counts()
    assert (counts.free.astype(int) + counts.wall).max() == 1
