"""Straight motions proved free, and how much clearance they keep.

While x, y and heading change linearly, a corner at distance r from the reference point leaves its chord by at most
r·Δheading²/8. The hull of a part's two placements, grown by this sag, holds the part all the way: what the hull keeps
from the walls, less the sag, is a lower bound of the clearance. Motions are halved until the bound tells.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled, kernel
from planners.insertion import order_of
from planners.orientations import nearest
from planners.outline import Outline, outline_of
from planners.robot import Robot
from planners.world import World

Floats = NDArray[np.float64]

DEPTH = 14  # halvings after which a motion that is neither free nor colliding is given up


class Course(NamedTuple):
    """A robot among walls: its corners (v, 2) with part k in rows first[k] to first[k + 1], the radius it is rounded
    by, the walls' ends (m, 4) and boxes (m, 4): least and greatest x, least and greatest y."""

    corners: Floats
    first: NDArray[np.int64]
    radius: float
    ends: Floats
    boxes: Floats


def course_of(world: World, robot: Robot) -> Course:
    """The arrays of `robot` in `world`."""
    outline: Outline = outline_of(robot)
    lows, highs = world.edges.min(axis=1), world.edges.max(axis=1)
    boxes = np.stack([lows[:, 0], highs[:, 0], lows[:, 1], highs[:, 1]], axis=1)
    return Course(outline.corners, outline.first, outline.radius, world.edges.reshape(-1, 4).copy(), boxes)


@kernel
def _hull(points: Floats) -> Floats:
    """Corners (k, 2) of the hull of a few points, counter-clockwise: the chain from below and the one from above."""
    # Ties in x go by y; points nearer than 1e-9 in x may swap, which moves the hull by less than a grid step.
    order = order_of(points[:, 0] + 1e-9 * points[:, 1])
    hull, count = np.empty((2 * points.shape[0], 2)), 0
    for sweep in range(2):
        base = count
        for step in range(points.shape[0]):
            row = order[step] if sweep == 0 else order[points.shape[0] - 1 - step]
            x, y = points[row, 0], points[row, 1]
            while count >= base + 2:
                ax, ay = hull[count - 1, 0] - hull[count - 2, 0], hull[count - 1, 1] - hull[count - 2, 1]
                if ax * (y - hull[count - 1, 1]) - ay * (x - hull[count - 1, 0]) > 0:
                    break
                count -= 1
            hull[count, 0], hull[count, 1] = x, y
            count += 1
        count -= 1
    return hull[: max(count, 1)].copy()


@kernel
def _hull_to_wall(hull: Floats, wall: Floats) -> float:
    """Distance between a convex hull (k, 2) and a wall (4,); 0 if they meet."""
    best, within, side = np.inf, True, np.empty(4)
    for k in range(hull.shape[0]):
        following = (k + 1) % hull.shape[0]
        for axis in range(2):
            side[axis], side[2 + axis] = hull[k, axis], hull[following, axis]
        turn = (side[2] - side[0]) * (wall[1] - side[1]) - (side[3] - side[1]) * (wall[0] - side[0])
        within = within and turn > 0
        best = min(best, nearest(side, wall)[2])
    return 0.0 if within else best


@kernel
def _swept(course: Course, part: int, motion: Floats) -> Floats:
    """Hull (k, 2) of the two placements of a part at the ends of a motion (2, 3)."""
    first, last = course.first[part], course.first[part + 1]
    points = np.empty((2 * (last - first), 2))
    for end in range(2):
        cosine, sine = np.cos(motion[end, 2]), np.sin(motion[end, 2])
        for k in range(first, last):
            x, y = course.corners[k, 0], course.corners[k, 1]
            points[2 * (k - first) + end, 0] = motion[end, 0] + cosine * x - sine * y
            points[2 * (k - first) + end, 1] = motion[end, 1] + sine * x + cosine * y
    return _hull(points)


@kernel
def bound(course: Course, motion: Floats, ceiling: float) -> float:
    """Lower bound of the clearance all along a motion (2, 3), at most `ceiling`; negative where it may collide."""
    turn, least = motion[1, 2] - motion[0, 2], ceiling
    for part in range(course.first.size - 1):
        reach = 0.0
        for k in range(course.first[part], course.first[part + 1]):
            reach = max(reach, np.hypot(course.corners[k, 0], course.corners[k, 1]))
        loss = course.radius + reach * turn * turn / 8
        hull = _swept(course, part, motion)
        low_x = high_x = hull[0, 0]
        low_y = high_y = hull[0, 1]
        for k in range(1, hull.shape[0]):
            low_x, high_x = min(low_x, hull[k, 0]), max(high_x, hull[k, 0])
            low_y, high_y = min(low_y, hull[k, 1]), max(high_y, hull[k, 1])
        for k in range(course.ends.shape[0]):
            near = least + loss
            if course.boxes[k, 0] > high_x + near or course.boxes[k, 1] < low_x - near:
                continue
            if course.boxes[k, 2] > high_y + near or course.boxes[k, 3] < low_y - near:
                continue
            least = min(least, _hull_to_wall(hull, course.ends[k]) - loss)
    return least


@compiled
def keeps(course: Course, motion: Floats, clearance: float) -> bool:
    """Whether a motion (2, 3) provably keeps more than `clearance` from all walls."""
    pieces, count = np.empty((DEPTH + 2, 2)), 1
    pieces[0, 0], pieces[0, 1] = 0.0, 1.0
    piece = np.empty((2, 3))
    while count > 0:
        count -= 1
        begin, end = pieces[count, 0], pieces[count, 1]
        for k in range(3):
            rise = motion[1, k] - motion[0, k]
            piece[0, k], piece[1, k] = motion[0, k] + begin * rise, motion[0, k] + end * rise
        if bound(course, piece, 2 * clearance + 1e-3) > clearance:
            continue
        for k in range(3):
            piece[0, k] = piece[1, k] = (piece[0, k] + piece[1, k]) / 2
        if end - begin < 0.5**DEPTH or bound(course, piece, 2 * clearance + 1e-3) <= clearance:
            return False
        middle = (begin + end) / 2
        pieces[count, 0], pieces[count, 1] = middle, end
        pieces[count + 1, 0], pieces[count + 1, 1] = begin, middle
        count += 2
    return True


@kernel
def _ceiling(course: Course, pose: Floats) -> float:
    """An upper bound of the clearance at a pose (3,): what the first corner keeps from the nearest wall."""
    piece, least = np.empty(4), np.inf
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    piece[0] = piece[2] = pose[0] + cosine * course.corners[0, 0] - sine * course.corners[0, 1]
    piece[1] = piece[3] = pose[1] + sine * course.corners[0, 0] + cosine * course.corners[0, 1]
    for k in range(course.ends.shape[0]):
        least = min(least, nearest(piece, course.ends[k])[2])
    return least - course.radius


@compiled
def clearance_of(course: Course, poses: Floats, precision: float) -> float:
    """Lower bound of the clearance along poses (p, 3), within about `precision` metres; at least one pose."""
    least, reach, piece = _ceiling(course, poses[0]), 0.0, np.empty((2, 3))
    for k in range(course.corners.shape[0]):
        reach = max(reach, np.hypot(course.corners[k, 0], course.corners[k, 1]))
    for leg in range(max(poses.shape[0] - 1, 1)):
        following = min(leg + 1, poses.shape[0] - 1)
        turn = abs(poses[following, 2] - poses[leg, 2])
        total = max(1, int(np.ceil(turn * np.sqrt(reach / (8 * precision)))))
        for each in range(total):
            for k in range(3):
                rise = poses[following, k] - poses[leg, k]
                piece[0, k] = poses[leg, k] + rise * each / total
                piece[1, k] = poses[leg, k] + rise * (each + 1) / total
            least = min(least, bound(course, piece, least))
    return least
