"""The estimate: where every scan was taken, how surely, and what was believed or refused on the way."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Decision:
    """What was decided about a scan, a match or a loop, and why. scans: the indices it concerns."""

    what: str
    scans: tuple[int, ...]
    accepted: bool
    reason: str


@dataclass(frozen=True, eq=False)
class Tie:
    """Keyframe `moving` was found at `pose` (3,) in the frame of `fixed`; information (3, 3) in moving's axes."""

    fixed: int
    moving: int
    pose: Floats
    information: Floats


@dataclass(frozen=True, eq=False)
class LandmarkTie:
    """Keyframe `pose` saw the landmark at `position` (2,) in its own frame; information (2, 2) in the same axes."""

    pose: int
    landmark: int
    position: Floats
    information: Floats


@dataclass(frozen=True, eq=False)
class Estimate:
    """poses (n, 3) in the frame of the first, covariances (n, 3, 3) in each pose's own axes, landmarks (l, 2),
    sightings (l,) of each landmark, keyframes (k,) scan indices that carry the graph, decisions in their order,
    calibration: the robot's constants as learnt from the log. ties, landmark_ties: the factors of the graph, between
    places in `keyframes` and in `landmarks`. mapped (n,): whether the scan stands in the map; the others fitted
    nowhere, or belong to sessions that were joined to no other and have frames of their own.
    """

    poses: Floats
    covariances: Floats
    landmarks: Floats
    sightings: NDArray[np.int64]
    keyframes: NDArray[np.int64]
    decisions: tuple[Decision, ...]
    calibration: dict[str, float]
    mapped: NDArray[np.bool_]
    ties: tuple[Tie, ...] = ()
    landmark_ties: tuple[LandmarkTie, ...] = ()
