"""Agreement: whether two placed sketches can be views of one room.

Walls of the one must lie on walls of the other that face the same way, and none may stand in the other's free space:
a right pose has no wall where the other saw through.
"""

from dataclasses import dataclass

import numpy as np

from frontend.compiled import compiled
from frontend.primal_sketch import PrimalSketch
from frontend.scan import Floats

PACE = 0.1  # metres between the places of a wall that are judged


@dataclass(frozen=True, eq=False)
class Agreement:
    """Of p poses, in metres of wall of both sketches (p,): laid on a wall, standing in free space.

    fixing: (p,) of the walls laid, how many metres across the direction in which they hold the pose least.
    """

    laid: Floats
    against: Floats
    fixing: Floats

    @property
    def support(self) -> Floats:
        """Share (p,) of the walls in common view that coincide."""
        return np.asarray(self.laid / np.maximum(self.laid + self.against, 1e-9))


def agreement(fixed: PrimalSketch, moving: PrimalSketch, poses: Floats, tolerance: float) -> Agreement:
    """How the walls agree at each pose (p, 3) of the moving sketch in the fixed frame. tolerance: metres."""
    rows = judge_poses(
        _boundary(fixed), fixed.lines.ends, fixed.origin, _boundary(moving), moving.lines.ends, moving.origin,
        poses, tolerance,
    )  # fmt: skip
    return Agreement(*rows.T)


def _boundary(sketch: PrimalSketch) -> Floats:
    """Edges (k, 2, 2) of the view."""
    return np.stack([sketch.positions, np.roll(sketch.positions, -1, axis=0)], axis=1)


@compiled
def judge_poses(
    boundary_a: Floats, walls_a: Floats, origin_a: Floats, boundary_b: Floats, walls_b: Floats, origin_b: Floats,
    poses: Floats, tolerance: float,
) -> Floats:  # fmt: skip
    """Rows (p, 3) as in an agreement, for views a and b and each pose of b in a."""
    rows = np.empty((poses.shape[0], 3))
    back = np.empty(3)
    for p in range(poses.shape[0]):
        c, s = np.cos(poses[p, 2]), np.sin(poses[p, 2])
        back[0], back[1] = -c * poses[p, 0] - s * poses[p, 1], s * poses[p, 0] - c * poses[p, 1]
        back[2] = -poses[p, 2]
        first = judge_walls(boundary_a, walls_a, _placed(walls_b, poses[p]), tolerance)
        second = judge_walls(boundary_b, walls_b, _placed(walls_a, back), tolerance)
        rows[p, 0], rows[p, 1] = first[0] + second[0], first[1] + second[1]
        xx, xy, yy = first[2], first[3], first[4]
        rows[p, 2] = 0.5 * (xx + yy) - np.sqrt((0.5 * (xx - yy)) ** 2 + xy * xy)
    return rows


@compiled
def _placed(walls: Floats, pose: Floats) -> Floats:
    c, s = np.cos(pose[2]), np.sin(pose[2])
    placed = np.empty_like(walls)
    placed[:, :, 0] = c * walls[:, :, 0] - s * walls[:, :, 1] + pose[0]
    placed[:, :, 1] = s * walls[:, :, 0] + c * walls[:, :, 1] + pose[1]
    return placed


@compiled
def judge_walls(
    boundary: Floats, own: Floats, walls: Floats, tolerance: float
) -> tuple[float, float, float, float, float]:
    """Of the walls (w, 2, 2): metres laid on own walls, metres inside the boundary, and Σ metres·n nᵀ of those laid.

    boundary: (k, 2, 2) edges of a star-shaped view. What lies outside it is not judged.
    """
    laid, against, xx, xy, yy = 0.0, 0.0, 0.0, 0.0, 0.0
    for w in range(walls.shape[0]):
        dx, dy = walls[w, 1, 0] - walls[w, 0, 0], walls[w, 1, 1] - walls[w, 0, 1]
        length = np.hypot(dx, dy)
        count = int(length / PACE) + 1
        for s in range(count):
            share = (s + 0.5) / count
            x, y = walls[w, 0, 0] + share * dx, walls[w, 0, 1] + share * dy
            weight = length / count
            if near_wall(own, x, y, dx, dy, tolerance):
                laid += weight
                xx += weight * (dy / length) ** 2
                xy -= weight * dx * dy / length**2
                yy += weight * (dx / length) ** 2
            elif _inside(boundary, x, y) and not near_wall(boundary, x, y, 0.0, 0.0, 1.5 * tolerance):
                against += weight
    return laid, against, xx, xy, yy


@compiled
def near_wall(edges: Floats, x: float, y: float, along_x: float, along_y: float, tolerance: float) -> bool:
    """Whether a point lies within the tolerance of any of the edges (k, 2, 2) that does not run against the direction.

    Edges have their free space on the left, so one that runs the other way is the other face of a wall.
    """
    for e in range(edges.shape[0]):
        ax, ay = edges[e, 0, 0], edges[e, 0, 1]
        dx, dy = edges[e, 1, 0] - ax, edges[e, 1, 1] - ay
        along = (x - ax) * dx + (y - ay) * dy
        square = dx * dx + dy * dy
        share = min(max(along / square, 0.0), 1.0) if square > 0 else 0.0
        close = (x - ax - share * dx) ** 2 + (y - ay - share * dy) ** 2 < tolerance * tolerance
        if close and dx * along_x + dy * along_y >= 0.0:
            return True
    return False


@compiled
def _inside(boundary: Floats, x: float, y: float) -> bool:
    """Whether a point lies inside the closed boundary (k, 2, 2), by crossings."""
    crossings = False
    for e in range(boundary.shape[0]):
        ax, ay, bx, by = boundary[e, 0, 0], boundary[e, 0, 1], boundary[e, 1, 0], boundary[e, 1, 1]
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            crossings = not crossings
    return crossings
