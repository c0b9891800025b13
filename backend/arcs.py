"""Arcs: regions of constant depth of one scan, and what a wall or an edge at a believed place would answer.

A wall answers from the foot of its normal, an edge from where it is. Either gives a range, known well, and a bearing,
known badly. Walls are frames (3,): a place on the wall and the heading of the normal into it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Booleans = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Arcs:
    """Arcs of one scan (k,) in the robot's frame.

    ranges: metres to the nearest surface, spread: of one of them. wall_bearings, wall_spreads: of a wall's normal;
    starts, stops: what was seen of the wall, metres leftward of its foot. edge_bearings, edge_spreads: of an edge.
    firm: surely a wall. rising: may be a wall.
    """

    ranges: Floats
    spread: float
    wall_bearings: Floats
    wall_spreads: Floats
    starts: Floats
    stops: Floats
    edge_bearings: Floats
    edge_spreads: Floats
    firm: Booleans
    rising: Booleans

    def as_wall(self, k: int) -> tuple[Floats, Floats]:
        """What arc k measured if it is a wall: range and bearing (2,), variances (2,)."""
        return np.array([self.ranges[k], self.wall_bearings[k]]), np.array([self.spread, self.wall_spreads[k]]) ** 2

    def as_edge(self, k: int) -> tuple[Floats, Floats]:
        """What arc k measured if it is an edge: range and bearing (2,), variances (2,)."""
        return np.array([self.ranges[k], self.edge_bearings[k]]), np.array([self.spread, self.edge_spreads[k]]) ** 2

    def sighted_wall(self, k: int, along: float) -> tuple[Floats, Floats]:
        """The frame (3,) of a wall in the robot's frame, covariance (3, 3), where arc k is its foot.

        along: metres leftward from the wall's origin to the foot. The bearing's error swings the origin about the foot.
        """
        bearing, variance = self.wall_bearings[k], self.wall_spreads[k] ** 2
        normal = np.array([np.cos(bearing), np.sin(bearing)])
        origin = self.ranges[k] * normal - along * np.array([-normal[1], normal[0]])
        covariance = np.diag([self.spread**2 + along**2 * variance, 1e4, variance])
        covariance[0, 2] = covariance[2, 0] = along * variance
        return np.array([*origin, bearing]), covariance

    def sighted_edge(self, k: int) -> tuple[Floats, Floats]:
        """The place (2,) of an edge in the robot's frame, and its covariance (2, 2)."""
        bearing = self.edge_bearings[k]
        along = np.array([np.cos(bearing), np.sin(bearing)])
        across = np.array([-along[1], along[0]])
        swing = (self.ranges[k] * self.edge_spreads[k]) ** 2
        return self.ranges[k] * along, np.outer(along, along) * self.spread**2 + np.outer(across, across) * swing


def seen_wall(pose: Floats, frame: Floats) -> tuple[Floats, Floats, float]:
    """Range and bearing (2,) of a wall (3,) from a pose (3,), their derivatives (2, 6) with respect to pose and wall,
    and how far leftward of the wall's origin the foot lies."""
    cosine, sine = np.cos(frame[2]), np.sin(frame[2])
    gap = frame[:2] - pose[:2]
    swing = cosine * gap[1] - sine * gap[0]
    seen = np.array([cosine * gap[0] + sine * gap[1], wrapped(frame[2] - pose[2])])
    slope = np.array([[-cosine, -sine, 0, cosine, sine, swing], [0, 0, -1, 0, 0, 1]])
    return seen, slope, -float(swing)


def seen_edge(pose: Floats, place: Floats) -> tuple[Floats, Floats]:
    """Range and bearing (2,) of an edge (2,) from a pose (3,), their derivatives (2, 5) with respect to both."""
    gap = place - pose[:2]
    distance = max(float(np.hypot(*gap)), 1e-6)
    x, y = gap / distance
    seen = np.array([distance, wrapped(np.arctan2(y, x) - pose[2])])
    slope = np.array([[-x, -y, 0, x, y], [y / distance, -x / distance, -1, -y / distance, x / distance]])
    return seen, slope


def wrapped(angle: float) -> float:
    """An angle brought into [−π, π)."""
    return float((angle + np.pi) % (2 * np.pi) - np.pi)
