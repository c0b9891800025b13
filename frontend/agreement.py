"""Agreement: whether two placed sketches can be views of one room.

Walls of the one must lie on walls of the other, and none may stand in the other's free space: a right pose has no wall
where the other saw through.
"""

import numpy as np

from frontend.compiled import compiled
from frontend.primal_sketch import PrimalSketch
from frontend.rigid_motion import inverse, transform
from frontend.scan import Floats


def agreement(fixed: PrimalSketch, moving: PrimalSketch, pose: Floats, tolerance: float) -> tuple[float, float]:
    """Share of the walls in common view that coincide, and share that stands in the other's free space.

    pose: (3,) of the moving sketch in the fixed frame. tolerance: metres. Both directions count alike.
    """
    here = _judge(fixed, _placed(moving.lines.ends, pose), tolerance)
    there = _judge(moving, _placed(fixed.lines.ends, inverse(pose)), tolerance)
    supported, contradicted, seen = np.array(here) + np.array(there)
    return float(supported / max(seen, 1.0)), float(contradicted / max(seen, 1.0))


def _placed(ends: Floats, pose: Floats) -> Floats:
    return transform(ends.reshape(-1, 2), pose).reshape(-1, 2, 2)


def _judge(sketch: PrimalSketch, walls: Floats, tolerance: float) -> tuple[float, float, float]:
    following = np.roll(sketch.positions, -1, axis=0)
    edges = np.stack([sketch.positions, following], axis=1) - sketch.origin
    return judge_walls(edges, sketch.lines.ends - sketch.origin, walls - sketch.origin, tolerance)


@compiled
def judge_walls(boundary: Floats, own: Floats, walls: Floats, tolerance: float) -> tuple[float, float, float]:
    """Of the sampled walls (w, 2, 2): metres supported by own walls, metres inside the boundary, metres judged.

    boundary: (k, 2, 2) edges of a star-shaped view around the origin. What lies outside it is not judged.
    """
    pace = 0.1
    supported, contradicted, seen = 0.0, 0.0, 0.0
    for w in range(walls.shape[0]):
        length = np.hypot(walls[w, 1, 0] - walls[w, 0, 0], walls[w, 1, 1] - walls[w, 0, 1])
        count = int(length / pace) + 1
        for s in range(count):
            share = (s + 0.5) / count
            x = (1 - share) * walls[w, 0, 0] + share * walls[w, 1, 0]
            y = (1 - share) * walls[w, 0, 1] + share * walls[w, 1, 1]
            weight = length / count
            if _near_wall(own, x, y, tolerance):
                supported += weight
                seen += weight
            elif _inside(boundary, x, y) and not _near_wall(boundary, x, y, 1.5 * tolerance):
                contradicted += weight
                seen += weight
    return supported, contradicted, seen


@compiled
def _near_wall(edges: Floats, x: float, y: float, tolerance: float) -> bool:
    """Whether a point lies within the tolerance of any of the edges (k, 2, 2)."""
    for e in range(edges.shape[0]):
        ax, ay = edges[e, 0, 0], edges[e, 0, 1]
        dx, dy = edges[e, 1, 0] - ax, edges[e, 1, 1] - ay
        along = (x - ax) * dx + (y - ay) * dy
        square = dx * dx + dy * dy
        share = min(max(along / square, 0.0), 1.0) if square > 0 else 0.0
        if (x - ax - share * dx) ** 2 + (y - ay - share * dy) ** 2 < tolerance * tolerance:
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
