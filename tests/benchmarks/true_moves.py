"""True moves between consecutive scans of a real log: another system's estimate, refined by laying wall on wall.

The refinement is written here, apart from the product's registration, so that nothing measures itself.
"""

from itertools import pairwise

import numpy as np
from scipy.spatial import KDTree

from frontend.rigid_motion import between, rotation, transform
from frontend.scan import Floats
from frontend.surface import Surface

GATES = (0.5, 0.3, 0.15, 0.1, 0.1, 0.1)  # metres within which walls pair, pass by pass


def true_moves(surfaces: list[Surface], poses: Floats) -> list[Floats | None]:
    """Pose (3,) of each scan in the frame of the one before; None where walls and the given poses (n, 3) disagree."""
    guesses = [between(a, b) for a, b in pairwise(poses)]
    return [_refined(*pair, guess) for pair, guess in zip(pairwise(surfaces), guesses, strict=True)]


def _refined(fixed: Surface, moving: Surface, guess: Floats) -> Floats | None:
    tree, pose = KDTree(fixed.points), guess.copy()
    for gate in np.repeat(GATES, 3):
        placed = transform(moving.points, pose)
        distances, nearest = tree.query(placed)
        partners = np.asarray(nearest)
        alike = np.sum(moving.normals @ rotation(pose[2]).T * fixed.normals[partners], axis=1) > 0.8
        paired = (distances < gate) & alike
        if np.sum(paired) < 20:
            return None
        normals, arms = fixed.normals[partners[paired]], placed[paired] - pose[:2]
        gaps = np.sum((fixed.points[partners[paired]] - placed[paired]) * normals, axis=1)
        slopes = np.column_stack([normals, normals[:, 1] * arms[:, 0] - normals[:, 0] * arms[:, 1]])
        weights = 1 / (1 + (gaps / 0.03) ** 2)
        # A corridor says nothing along itself: there the given pose must hold.
        normal = slopes.T @ (slopes * weights[:, None]) + 1e-5 * np.sum(paired) * np.eye(3)
        pose = pose + np.linalg.solve(normal, slopes.T @ (weights * gaps))
    return pose if np.hypot(*(pose - guess)[:2]) < 0.2 else None
