"""An independent proof that a motion is free: it shares no code with the planners that it checks.

While x, y and heading change linearly, a point at distance r from the reference point leaves the chord between its two
ends by at most r·Δheading²/8. So a convex part stays within that sag of the hull of its two placements. A piece of
the motion whose hull, grown by the sag, meets no boundary edge and starts in free space is free as a whole; other
pieces are halved until they are, until a placement overlaps an obstacle, or until the pieces have become too short.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon, Polygon, STRtree

from planners.robot import Robot

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

HALVINGS = 34  # pieces shorter than 2^-34 of a motion are given up as undecided


@dataclass(frozen=True, eq=False)
class Certificate:
    """Verdict over a whole path. witness: pose (3,) that collides or stayed undecided. pieces: hulls examined."""

    verdict: Literal["certified", "collision", "undecided"]
    witness: Floats | None
    pieces: int

    def __bool__(self) -> bool:
        """Whether the continuous motion is proved free."""
        return self.verdict == "certified"


def certify(poses: Floats, robot: Robot, free: Polygon | MultiPolygon) -> Certificate:
    """Examine the motion through `poses` (p, 3), p ≥ 1, of `robot` in `free`."""
    poses = np.asarray(poses, dtype=float)
    tree, pieces = _boundary(free), 0
    motions = np.stack([poses[:-1], poses[1:]], axis=1) if len(poses) > 1 else np.stack([poses, poses], axis=1)
    overlapping = _collides(poses, robot, free)
    if overlapping.any():
        return Certificate("collision", poses[overlapping][0], len(poses))
    for _ in range(HALVINGS):
        pieces += len(motions)
        motions = motions[~_proved(motions, robot, free, tree)]
        if not len(motions):
            return Certificate("certified", None, pieces)
        middles = motions.mean(axis=1)
        overlapping = _collides(middles, robot, free)
        if overlapping.any():
            return Certificate("collision", middles[overlapping][0], pieces)
        motions = np.concatenate([np.stack([motions[:, 0], middles], 1), np.stack([middles, motions[:, 1]], 1)])
    return Certificate("undecided", motions[0, 0], pieces)


def _boundary(free: Polygon | MultiPolygon) -> STRtree:
    """All boundary edges as separate line strings."""
    rings = shapely.get_rings(shapely.get_parts(free))
    corners = [shapely.get_coordinates(ring) for ring in rings]
    edges = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in corners])
    return STRtree(np.asarray(shapely.linestrings(edges)))


def _placed(part: Floats, poses: Floats) -> Floats:
    """Corners (n, k, 2) of a part at `poses` (n, 3)."""
    cosine, sine = np.cos(poses[:, 2:]), np.sin(poses[:, 2:])
    x = poses[:, :1] + cosine * part[:, 0] - sine * part[:, 1]
    y = poses[:, 1:2] + sine * part[:, 0] + cosine * part[:, 1]
    return np.stack([x, y], axis=2)


def _proved(motions: Floats, robot: Robot, free: Polygon | MultiPolygon, tree: STRtree) -> Bools:
    """Which of `motions` (n, 2, 3) are free, by hull and sag."""
    proved = np.ones(len(motions), dtype=bool)
    turn = motions[:, 1, 2] - motions[:, 0, 2]
    for part in robot.parts:
        sag = np.linalg.norm(part, axis=1).max() * turn**2 / 8 + robot.radius
        ends = np.concatenate([_placed(part, motions[:, 0]), _placed(part, motions[:, 1])], axis=1)
        hulls = shapely.convex_hull(shapely.multipoints(ends))
        proved[tree.query(hulls, predicate="dwithin", distance=sag)[0]] = False
        proved &= shapely.contains_xy(free, ends[:, 0, 0], ends[:, 0, 1])
    return proved


def _collides(poses: Floats, robot: Robot, free: Polygon | MultiPolygon) -> Bools:
    """Which placements leave free space."""
    outside = np.zeros(len(poses), dtype=bool)
    shapely.prepare(free)
    for part in robot.parts:
        placed = _placed(part, poses)
        outlines = shapely.points(placed[:, 0]) if len(part) < 3 else shapely.polygons(placed)
        outside |= ~shapely.covers(free, outlines)
        if robot.radius:
            outside |= shapely.distance(free.boundary, outlines) < robot.radius
    return outside
