"""Labels for boxes of configuration space: EMPTY (free throughout), FULL (colliding throughout), MIXED (not known).

Brooks & Lozano-Pérez 1985. For headings within half a width h of a middle heading, every placement of a convex part
lies in the hull of its corners turned by −h and +h and pushed out to r / cos h in the middle: the outer hull. By
duality, every placement contains the points whose products with each side's normal turned by −h and +h stay below the
side's offset c, and below c·cos h with the normal in the middle: the inner core. Both labels are therefore sound.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled, kernel
from planners.outline import Outline

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

MIXED, EMPTY, FULL, SPLIT, SMALL = 0, 1, 2, 3, 4  # SPLIT: replaced by its halves; SMALL: mixed, but not cut any more


class Walls(NamedTuple):
    """Boundary edges for the compiled loops: ends (m, 4), margin in metres by which labels must hold."""

    ends: Floats
    margin: float


@kernel
def inside(ends: Floats, x: float, y: float) -> bool:
    """Whether a point that is on no edge lies in free space, by counting crossings."""
    odd = False
    for k in range(ends.shape[0]):
        x0, y0, x1, y1 = ends[k, 0], ends[k, 1], ends[k, 2], ends[k, 3]
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) * (x1 - x0) / (y1 - y0):
            odd = not odd
    return odd


@kernel
def _outer_hull(outline: Outline, part: int, heading: float, half: float) -> Floats:
    """Points (3k, 2) whose hull contains a part at every heading within `half` of `heading`."""
    first, last = outline.first[part], outline.first[part + 1]
    points = np.empty((3 * (last - first), 2))
    grown = 1 / np.cos(half)
    for turn in range(3):
        angle = heading + (turn - 1) * half
        scale = grown if turn == 1 else 1.0
        cosine, sine = np.cos(angle) * scale, np.sin(angle) * scale
        for k in range(first, last):
            x, y = outline.corners[k, 0], outline.corners[k, 1]
            points[3 * (k - first) + turn, 0] = cosine * x - sine * y
            points[3 * (k - first) + turn, 1] = sine * x + cosine * y
    return points


@kernel
def _support(points: Floats, x: float, y: float) -> float:
    farthest = -np.inf
    for k in range(points.shape[0]):
        farthest = max(farthest, points[k, 0] * x + points[k, 1] * y)
    return farthest


@kernel
def _outer_faces(outline: Outline, part: int, points: Floats, box: Floats) -> Floats:
    """Directions and supports (f, 3) that bound the outer hull grown by the box's half sides.

    box: (6,) centre x, y, heading and half sizes.
    """
    corners = outline.corners[outline.first[part] : outline.first[part + 1]]
    sides = outline.sides[outline.first[part] : outline.first[part + 1]]
    faces = np.empty((4 + corners.shape[0] + 2 * sides.shape[0], 3))
    for k in range(4):
        faces[k, 0], faces[k, 1] = (1 - k if k % 2 == 0 else 0), (2 - k if k % 2 == 1 else 0)
    cosine, sine = np.cos(box[2]), np.sin(box[2])
    for k in range(corners.shape[0]):
        length = max(np.hypot(corners[k, 0], corners[k, 1]), 1e-300)
        faces[4 + k, 0] = (cosine * corners[k, 0] - sine * corners[k, 1]) / length
        faces[4 + k, 1] = (sine * corners[k, 0] + cosine * corners[k, 1]) / length
    for turn in range(2):
        angle = box[2] + (2 * turn - 1) * box[5]
        cosine, sine = np.cos(angle), np.sin(angle)
        for k in range(sides.shape[0]):
            row = 4 + corners.shape[0] + 2 * k + turn
            faces[row, 0] = cosine * sides[k, 0] - sine * sides[k, 1]
            faces[row, 1] = sine * sides[k, 0] + cosine * sides[k, 1]
    for k in range(faces.shape[0]):
        x, y = faces[k, 0], faces[k, 1]
        faces[k, 2] = _support(points, x, y) + box[3] * abs(x) + box[4] * abs(y)
    return faces


@kernel
def _core_faces(outline: Outline, part: int, box: Floats) -> Floats:
    """Half-planes (f, 3) whose intersection lies in a part at every configuration of the box."""
    sides = outline.sides[outline.first[part] : outline.first[part + 1]]
    faces = np.empty((3 * sides.shape[0], 3))
    for turn in range(3):
        angle = box[2] + (turn - 1) * box[5]
        cosine, sine = np.cos(angle), np.sin(angle)
        shrunk = np.cos(box[5]) if turn == 1 else 1.0
        for k in range(sides.shape[0]):
            x, y = cosine * sides[k, 0] - sine * sides[k, 1], sine * sides[k, 0] + cosine * sides[k, 1]
            row = 3 * k + turn
            faces[row, 0], faces[row, 1] = x, y
            faces[row, 2] = sides[k, 2] * shrunk - box[3] * abs(x) - box[4] * abs(y)
    return faces


@kernel
def _meets(faces: Floats, points: Floats, box: Floats, wall: Floats, margin: float) -> bool:
    """Whether a wall (4,) comes within `margin` of the grown outer hull: no direction separates them."""
    x0, y0, x1, y1 = wall[0] - box[0], wall[1] - box[1], wall[2] - box[0], wall[3] - box[1]
    for k in range(faces.shape[0]):
        x, y = faces[k, 0], faces[k, 1]
        if min(x * x0 + y * y0, x * x1 + y * y1) > faces[k, 2] + margin:
            return False
    length = np.hypot(x1 - x0, y1 - y0)
    x, y = (y0 - y1) / length, (x1 - x0) / length
    offset = x * x0 + y * y0
    reach = box[3] * abs(x) + box[4] * abs(y) + margin
    return bool(offset <= _support(points, x, y) + reach and -offset <= _support(points, -x, -y) + reach)


@kernel
def _pierces(faces: Floats, box: Floats, wall: Floats, margin: float) -> bool:
    """Whether a wall (4,) enters the core by more than `margin`: the part of it inside all half-planes is not empty."""
    x0, y0 = wall[0] - box[0], wall[1] - box[1]
    dx, dy = wall[2] - wall[0], wall[3] - wall[1]
    enter, leave = 0.0, 1.0
    for k in range(faces.shape[0]):
        room = faces[k, 2] - margin - faces[k, 0] * x0 - faces[k, 1] * y0
        speed = faces[k, 0] * dx + faces[k, 1] * dy
        if speed == 0.0:
            if room <= 0.0:
                return False
        elif speed > 0.0:
            leave = min(leave, room / speed)
        else:
            enter = max(enter, room / speed)
        if enter >= leave:
            return False
    return True


@compiled
def label_box(outer: Outline, core: Outline, walls: Walls, box: Floats, near: Ints, kept: Ints) -> tuple[int, int, int]:
    """Label, number of walls kept and witness wall (−1 without) of a box (6,).

    near: the walls that meet the enclosing box's outer hull; kept: (≥ near.size,) receives those that meet this one's.
    """
    count, free = 0, True
    meets = np.zeros(near.size, np.uint8)
    for part in range(outer.first.size - 1):
        points = _outer_hull(outer, part, box[2], box[5])
        faces, core_faces = _outer_faces(outer, part, points, box), _core_faces(core, part, box)
        alone = True
        for k in range(near.size):
            wall = walls.ends[near[k]]
            if _meets(faces, points, box, wall, walls.margin):
                meets[k], alone = 1, False
                if _pierces(core_faces, box, wall, 8 * walls.margin):
                    return FULL, 0, near[k]
        if alone and not inside(walls.ends, box[0] + points[0, 0], box[1] + points[0, 1]):
            return FULL, 0, -1
        free = free and alone
    if free:
        return EMPTY, 0, -1
    for k in range(near.size):
        if meets[k] == 1:
            kept[count] = near[k]
            count += 1
    return MIXED, count, -1
