"""The pose that paired knots ask for: weighted least squares over their places and the directions of their walls."""

from dataclasses import dataclass

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Floats


@dataclass(frozen=True, eq=False)
class PairedKnots:
    """Paired knots in their own frames, with covariances; turns: (p,) heading the walls of each ask for, or nan."""

    fixed: Floats
    fixed_covariances: Floats
    moving: Floats
    moving_covariances: Floats
    turns: Floats


def pose_of_pairs(pairs: PairedKnots, start: Floats | None, wall_noise: float) -> tuple[Floats, Floats, float]:
    """Pose (3,) of the moving frame, its information (3, 3), and the root mean square distance left, metres.

    start: (3,) where to linearise first; None finds one, for which two pairs or one with a direction are needed.
    """
    first = start if start is not None else closed_form(pairs.fixed, pairs.moving, pairs.turns)
    pose, information = gauss_newton(
        pairs.fixed, pairs.fixed_covariances, pairs.moving, pairs.moving_covariances, pairs.turns, first, wall_noise
    )
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    placed = pairs.moving @ np.array([[cosine, sine], [-sine, cosine]]) + pose[:2]
    return pose, information, float(np.sqrt(np.mean(np.sum((pairs.fixed - placed) ** 2, axis=1))))


@compiled
def closed_form(fixed: Floats, moving: Floats, turns: Floats) -> Floats:
    """The unweighted rigid motion (3,) from moving to fixed (p, 2), headed as the walls ask where any does."""
    sine, cosine = 0.0, 0.0
    ax, ay, bx, by = np.mean(fixed[:, 0]), np.mean(fixed[:, 1]), np.mean(moving[:, 0]), np.mean(moving[:, 1])
    for p in range(turns.size):
        if not np.isnan(turns[p]):
            sine += np.sin(turns[p])
            cosine += np.cos(turns[p])
    if sine == 0.0 and cosine == 0.0:
        for p in range(turns.size):
            cosine += (fixed[p, 0] - ax) * (moving[p, 0] - bx) + (fixed[p, 1] - ay) * (moving[p, 1] - by)
            sine += (fixed[p, 1] - ay) * (moving[p, 0] - bx) - (fixed[p, 0] - ax) * (moving[p, 1] - by)
    heading = np.arctan2(sine, cosine)
    c, s = np.cos(heading), np.sin(heading)
    return np.array([ax - c * bx + s * by, ay - s * bx - c * by, heading])


@compiled
def gauss_newton(
    fixed: Floats, fixed_covariances: Floats, moving: Floats, moving_covariances: Floats,
    turns: Floats, start: Floats, wall_noise: float,
) -> tuple[Floats, Floats]:  # fmt: skip
    """Pose (3,) and its information (3, 3) after four steps from `start`."""
    pose = start.copy()
    information = np.eye(3)
    slope = np.zeros((2, 3))
    slope[0, 0] = slope[1, 1] = 1.0
    turn = np.empty((2, 2))
    for _ in range(4):
        information = np.zeros((3, 3))
        pull = np.zeros(3)
        c, s = np.cos(pose[2]), np.sin(pose[2])
        turn[0, 0], turn[0, 1], turn[1, 0], turn[1, 1] = c, -s, s, c
        for p in range(turns.size):
            arm = turn @ moving[p]
            slope[0, 2], slope[1, 2] = -arm[1], arm[0]
            weighted = slope.T @ np.linalg.inv(fixed_covariances[p] + turn @ moving_covariances[p] @ turn.T)
            information += weighted @ slope
            pull += weighted @ (fixed[p] - arm - pose[:2])
            if not np.isnan(turns[p]):
                information[2, 2] += 1.0 / wall_noise**2
                pull[2] += ((turns[p] - pose[2] + np.pi) % (2 * np.pi) - np.pi) / wall_noise**2
        pose += np.linalg.solve(information, pull)
    pose[2] = np.pi - (np.pi - pose[2]) % (2 * np.pi)
    return pose, information
