"""Ballots: what a placed view votes, its free polygon and a strip behind every real edge.

The strip reaches from the surface outward along the two beams that measured it, so the strips of one view
never overlap each other or its free space: a view has one vote per cell.
"""

import numpy as np
from numpy.typing import NDArray

from backend.evidence import Ballot

Floats = NDArray[np.float64]
STEEPEST = 1 / 3  # cosine of incidence below which a strip no longer keeps its full depth


def ballot_of(ring: Floats, real: NDArray[np.bool_], origin: Floats, depth: float, cell: float) -> Ballot:
    """The votes of a view's ring (m, 2) in the room, seen from `origin` (2,); strips `depth` metres thick."""
    real = real & (np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1) > 1e-9)
    beam = ring - origin
    beam = beam / np.maximum(np.linalg.norm(beam, axis=1, keepdims=True), 1e-9)
    first = np.flatnonzero(real)
    second = (first + 1) % len(ring)
    edge = ring[second] - ring[first]
    normal = np.stack([edge[:, 1], -edge[:, 0]], axis=1) / np.linalg.norm(edge, axis=1, keepdims=True)
    reach = depth / np.maximum(np.stack([np.sum(normal * beam[i], axis=1) for i in (first, second)]), STEEPEST)
    strips = np.stack(
        [
            ring[first],
            ring[second],
            ring[second] + reach[1][:, None] * beam[second],
            ring[first] + reach[0][:, None] * beam[first],
        ],
        axis=1,
    )
    return Ballot(ring / cell, strips.reshape(-1, 2) / cell)
