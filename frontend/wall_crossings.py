"""Where the long walls of a sketch would meet: corners that need not be seen, to find a place by when knots are few.

Two crossings of walls alike in turn ask for one pose. They share no knots, so what they propose must be verified.
"""

import numpy as np

from frontend.compiled import compiled
from frontend.lines import Lines
from frontend.scan import Floats

MOST_WALLS = 8  # of a sketch, the longest
LEAST_WALL = 0.4  # metres
LEAST_TURN = 0.5  # radians between walls, below which their crossing is unsure


def wall_crossings(lines: Lines) -> Floats:
    """Crossings (c, 4) of the longest walls: x, y, and the directions of the two, the second to the left."""
    lengths = np.linalg.norm(lines.ends[:, 1] - lines.ends[:, 0], axis=1)
    longest = np.argsort(-lengths, kind="stable")[:MOST_WALLS]
    return crossings_of(lines.ends[longest[lengths[longest] >= LEAST_WALL]])


@compiled
def crossings_of(walls: Floats) -> Floats:
    """Crossings (c, 4) of walls (w, 2, 2) that turn enough."""
    found, rows = 0, np.empty((walls.shape[0] ** 2, 4))
    for a in range(walls.shape[0]):
        ax, ay = walls[a, 1, 0] - walls[a, 0, 0], walls[a, 1, 1] - walls[a, 0, 1]
        for b in range(walls.shape[0]):
            bx, by = walls[b, 1, 0] - walls[b, 0, 0], walls[b, 1, 1] - walls[b, 0, 1]
            sine = (ax * by - ay * bx) / np.sqrt((ax * ax + ay * ay) * (bx * bx + by * by))
            if sine < np.sin(LEAST_TURN):
                continue
            share = ((walls[b, 0, 0] - walls[a, 0, 0]) * by - (walls[b, 0, 1] - walls[a, 0, 1]) * bx) / (
                ax * by - ay * bx
            )
            rows[found, 0], rows[found, 1] = walls[a, 0, 0] + share * ax, walls[a, 0, 1] + share * ay
            rows[found, 2], rows[found, 3] = np.arctan2(ay, ax), np.arctan2(by, bx)
            found += 1
    return rows[:found]


@compiled
def poses_of_crossings(fixed: Floats, moving: Floats, gate: float) -> Floats:
    """The poses (p, 3) of the moving frame that two crossings (a, 4), (b, 4) of one turn, within the gate, ask for."""
    found, poses = 0, np.empty((fixed.shape[0] * moving.shape[0], 3))
    for a in range(fixed.shape[0]):
        for b in range(moving.shape[0]):
            first = _wrapped(fixed[a, 2] - moving[b, 2])
            off = _wrapped(fixed[a, 3] - moving[b, 3] - first)
            if abs(off) > gate:
                continue
            heading = first + 0.5 * off
            c, s = np.cos(heading), np.sin(heading)
            poses[found, 0] = fixed[a, 0] - c * moving[b, 0] + s * moving[b, 1]
            poses[found, 1] = fixed[a, 1] - s * moving[b, 0] - c * moving[b, 1]
            poses[found, 2] = _wrapped(heading)
            found += 1
    return poses[:found]


@compiled
def _wrapped(angle: float) -> float:
    return float(np.pi - (np.pi - angle) % (2 * np.pi))
