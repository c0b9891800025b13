"""Shorter motions of the same kind: straight motions between places of a path, each proved free before it is taken."""

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled, kernel
from planners.motion import Course, keeps

Floats = NDArray[np.float64]

GOLDEN = 0.6180339887498949  # successive multiples, modulo 1, fill an interval evenly


@kernel
def _cost(first: Floats, second: Floats, turn_cost: float) -> float:
    moved = np.hypot(second[0] - first[0], second[1] - first[1])
    return float(moved + turn_cost * abs(second[2] - first[2]))


@kernel
def _leaped(course: Course, poses: Floats, clearance: float) -> Floats:
    """Poses (k, 3) without those that a straight motion can leave out: from each, as far as doubling steps succeed."""
    kept, count, here, motion = np.empty_like(poses), 0, 0, np.empty((2, 3))
    while here < poses.shape[0]:
        for k in range(3):
            kept[count, k] = motion[0, k] = poses[here, k]
        count += 1
        step, following = poses.shape[0] - 1 - here, here + 1
        while step > 1:
            for k in range(3):
                motion[1, k] = poses[here + step, k]
            if keeps(course, motion, clearance):
                following = here + step
                break
            step //= 2
        here = following
    return kept[:count].copy()


@kernel
def _at(poses: Floats, lengths: Floats, place: float) -> tuple[int, Floats]:
    """The leg that holds a place, counted in cost from the start, and the pose (3,) there."""
    leg = min(max(int(np.searchsorted(lengths, place, side="right")) - 1, 0), poses.shape[0] - 2)
    span = lengths[leg + 1] - lengths[leg]
    share = min(max((place - lengths[leg]) / span, 0.0), 1.0) if span > 0 else 0.0
    pose = np.empty(3)
    for k in range(3):
        pose[k] = poses[leg, k] + share * (poses[leg + 1, k] - poses[leg, k])
    return leg, pose


@kernel
def _spliced(poses: Floats, first: int, last: int, motion: Floats) -> Floats:
    """Poses up to leg `first`, the motion (2, 3), and the poses after leg `last`."""
    shorter = np.empty((first + 1 + 2 + poses.shape[0] - last - 1, 3))
    for row in range(shorter.shape[0]):
        for k in range(3):
            if row <= first:
                shorter[row, k] = poses[row, k]
            elif row <= first + 2:
                shorter[row, k] = motion[row - first - 1, k]
            else:
                shorter[row, k] = poses[last + row - first - 2, k]
    return shorter


@compiled
def shortened(course: Course, poses: Floats, clearance: float, turn_cost: float, rounds: int) -> Floats:
    """Poses (k, 3) of a motion no longer than `poses` (p, 3), counting `turn_cost` metres per radian.

    Straight motions replace what lies between two places if they provably keep `clearance`. Places are tried at all
    scales: far apart first, then closer about the corners that are left. rounds: how many are tried.
    """
    poses, motion = _leaped(course, poses, clearance), np.empty((2, 3))
    for attempt in range(rounds):
        if poses.shape[0] < 3:
            break
        lengths = np.zeros(poses.shape[0])
        for row in range(poses.shape[0] - 1):
            lengths[row + 1] = lengths[row] + _cost(poses[row], poses[row + 1], turn_cost)
        corner = 1 + attempt % (poses.shape[0] - 2)
        spread = 0.5 ** ((attempt // (poses.shape[0] - 2)) % 10)
        tilt = 0.25 + 0.5 * ((attempt * GOLDEN) % 1.0)
        width = spread * lengths[-1]
        first, begin = _at(poses, lengths, max(lengths[corner] - tilt * width, 0.0))
        last, end = _at(poses, lengths, min(lengths[corner] + (1 - tilt) * width, lengths[-1]))
        for k in range(3):
            motion[0, k], motion[1, k] = begin[k], end[k]
        saved = lengths[corner] * 0.0 + width - _cost(begin, end, turn_cost)
        if first < last and saved > 1e-9 * lengths[-1] and keeps(course, motion, clearance):
            poses = _leaped(course, _spliced(poses, first, last, motion), clearance)
    return poses
