"""The pose that lays walls on walls: point-to-line least squares over the ends of their overlaps."""

import numpy as np

from frontend.compiled import compiled
from frontend.lines import Lines
from frontend.scan import Floats

LEAST_OVERLAP = 0.15  # metres two walls must share
SAME_WAY = 0.97  # cosine between the directions of two views of one wall


def pose_of_walls(fixed: Lines, moving: Lines, start: Floats, tolerance: float, noise: float) -> tuple[Floats, Floats]:
    """Pose (3,) of the moving lines and its information (3, 3), from walls that lie within the tolerance at the start.

    noise: metres that two views of one wall differ by besides the spread of their fits.
    """
    return laid_on_walls(
        fixed.ends, fixed.offset_spread**2 + 0.5 * noise**2, moving.ends, moving.offset_spread**2 + 0.5 * noise**2,
        start, tolerance,
    )  # fmt: skip


@compiled
def laid_on_walls(
    fixed: Floats, fixed_variances: Floats, moving: Floats, moving_variances: Floats, start: Floats, tolerance: float
) -> tuple[Floats, Floats]:
    """Pose (3,) and information (3, 3) after four Gauss–Newton steps on walls (a, 2, 2) and (b, 2, 2)."""
    pose, information = start.copy(), np.zeros((3, 3))
    slope = np.empty(3)
    for _ in range(4):
        information, pull = 1e-6 * np.eye(3), np.zeros(3)
        c, s = np.cos(pose[2]), np.sin(pose[2])
        turn = np.array([[c, s], [-s, c]])
        for b in range(moving.shape[0]):
            wall = moving[b] @ turn + pose[:2]
            for a in range(fixed.shape[0]):
                along = fixed[a, 1] - fixed[a, 0]
                length = np.hypot(along[0], along[1])
                along /= length
                low, high = _overlap(fixed[a, 0], along, length, wall)
                if high - low < LEAST_OVERLAP:
                    continue
                ends = _gaps(fixed[a, 0], along, wall, low, high)
                if max(abs(ends[0]), abs(ends[1])) > tolerance:
                    continue
                weight = 0.5 / (fixed_variances[a] + moving_variances[b])
                for end, place in ((0, low), (1, high)):
                    x, y = fixed[a, 0, 0] + place * along[0] - pose[0], fixed[a, 0, 1] + place * along[1] - pose[1]
                    slope[0], slope[1] = -along[1], along[0]
                    slope[2] = along[1] * y + along[0] * x
                    information += weight * np.outer(slope, slope)
                    pull -= weight * slope * ends[end]
        pose += np.linalg.solve(information, pull)
    pose[2] = np.pi - (np.pi - pose[2]) % (2 * np.pi)
    return pose, information


@compiled
def _overlap(origin: Floats, along: Floats, length: float, wall: Floats) -> tuple[float, float]:
    """The stretch of a wall, in metres from its origin, that another wall facing the same way covers; else (0, 0)."""
    dx, dy = wall[1, 0] - wall[0, 0], wall[1, 1] - wall[0, 1]
    if dx * along[0] + dy * along[1] < SAME_WAY * np.hypot(dx, dy):
        return 0.0, 0.0
    first = (wall[0, 0] - origin[0]) * along[0] + (wall[0, 1] - origin[1]) * along[1]
    last = (wall[1, 0] - origin[0]) * along[0] + (wall[1, 1] - origin[1]) * along[1]
    return max(0.0, first), min(length, last)


@compiled
def _gaps(origin: Floats, along: Floats, wall: Floats, low: float, high: float) -> tuple[float, float]:
    """How far to the left of a wall another one lies at both ends of their overlap."""
    near = (wall[0, 1] - origin[1]) * along[0] - (wall[0, 0] - origin[0]) * along[1]
    far = (wall[1, 1] - origin[1]) * along[0] - (wall[1, 0] - origin[0]) * along[1]
    first = (wall[0, 0] - origin[0]) * along[0] + (wall[0, 1] - origin[1]) * along[1]
    last = (wall[1, 0] - origin[0]) * along[0] + (wall[1, 1] - origin[1]) * along[1]
    slant = (far - near) / (last - first)
    return near + slant * (low - first), near + slant * (high - first)
