"""A start or goal in a tight place is tied to the nearest free boxes by straight motions, each proved free."""

import numpy as np
from numpy.typing import NDArray

from planners.cells import EMPTY, SMALL
from planners.motion import Course, keeps
from planners.subdivision import CELLS, Tree

Floats = NDArray[np.float64]

TRIES = 100  # nearest boxes that are tried


def moored(tree: Tree, course: Course, pose: Floats, clearance: float, period: float) -> Floats:
    """A pose (3,) in the middle of a free box that `pose` reaches straight, or `pose` itself.

    Only a pose whose own box stayed partly free is moved; one with a free heading stays. period: after which headings
    look the same.
    """
    made = slice(0, int(tree.used[CELLS]))
    middles, labels = (tree.lows[made] + tree.highs[made]) / 2, tree.labels[made]
    middles[:, 2] += period * np.round((pose[2] - middles[:, 2]) / period)
    halves = (tree.highs[made] - tree.lows[made]) / 2
    around = (np.abs(middles - pose) <= halves + 1e-12).all(axis=1)
    if np.isnan(pose[2]) or not (labels[around] == SMALL).any():
        return pose
    free = np.flatnonzero(labels == EMPTY)
    away = np.abs(middles[free] - pose) * [1.0, 1.0, tree.reach]
    nearest_first = free[np.argsort(away.sum(axis=1))[:TRIES]]
    motions = (np.stack([pose, middle]) for middle in middles[nearest_first])
    return next((motion[1] for motion in motions if keeps(course, motion, clearance)), pose)
