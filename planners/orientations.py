"""Legal orientations: the headings a robot may hold all along a straight piece of its way (Brooks 1983).

A wall that lies behind a line at distance d from the piece, with the line's normal at angle ψ towards the piece, is
missed whenever all corners r∠f stay on the near side: corner k forbids the arc about ψ + π − f of half width
arccos(d/r), and nothing if r ≤ d. Every line that separates a wall from the piece gives such a set, and a heading that
is legal by any of them misses the wall. Tried are the line across the nearest points, the wall's own line (the side of
a cone), and the lines along and across the piece (sides that go on parallel past a wall's end; front and back).

A set of headings is rows (k, 2) of disjoint increasing intervals in [0, 2π].
"""

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled, kernel
from planners.insertion import order_of

Floats = NDArray[np.float64]

CIRCLE = 2 * np.pi
MOST = 24  # intervals in a set; further ones are given up, which is sound


@kernel
def _without(legal: Floats, count: int, low: float, high: float) -> int:
    """Take the open interval low … high out of a set in its buffer; returns the new count."""
    kept = 0
    pieces = np.empty((MOST, 2))
    for k in range(count):
        for side in range(2):
            begin = legal[k, 0] if side == 0 else max(legal[k, 0], high)
            end = min(legal[k, 1], low) if side == 0 else legal[k, 1]
            if begin < end and kept < MOST and not (side == 1 and low >= legal[k, 1]):
                pieces[kept, 0], pieces[kept, 1] = begin, end
                kept += 1
    for k in range(kept):
        legal[k, 0], legal[k, 1] = pieces[k, 0], pieces[k, 1]
    return kept


@kernel
def _beside_line(polar: Floats, angle: float, room: float, legal: Floats) -> int:
    """Fill `legal` with the headings at which all corners stay within `room` of the piece, towards a line.

    polar: (v, 2) distance and angle of the corners; angle: of the line's normal towards the piece.
    """
    legal[0, 0], legal[0, 1] = 0.0, CIRCLE
    count = 1
    for k in range(polar.shape[0]):
        if polar[k, 0] <= room:
            continue
        if room <= -polar[k, 0]:
            return 0
        half = np.arccos(room / polar[k, 0])
        low = (angle + np.pi - polar[k, 1] - half) % CIRCLE
        high = low + 2 * half
        count = _without(legal, count, low, high)
        if high > CIRCLE:
            count = _without(legal, count, low - CIRCLE, high - CIRCLE)
    return count


@compiled
def intersected(first: Floats, second: Floats) -> Floats:
    """The headings in both sets."""
    both = np.empty((first.shape[0] + second.shape[0], 2))
    count, i, j = 0, 0, 0
    while i < first.shape[0] and j < second.shape[0]:
        low, high = max(first[i, 0], second[j, 0]), min(first[i, 1], second[j, 1])
        if low < high:
            both[count, 0], both[count, 1] = low, high
            count += 1
        if first[i, 1] < second[j, 1]:
            i += 1
        else:
            j += 1
    return both[:count].copy()


@kernel
def _united(pieces: Floats, count: int) -> Floats:
    """The set that `count` intervals in any order make up."""
    order = order_of(pieces[:count, 0].copy())
    union = np.empty((count, 2))
    kept = 0
    for k in range(count):
        low, high = pieces[order[k], 0], pieces[order[k], 1]
        if kept > 0 and low <= union[kept - 1, 1]:
            union[kept - 1, 1] = max(union[kept - 1, 1], high)
        else:
            union[kept, 0], union[kept, 1] = low, high
            kept += 1
    return union[:kept].copy()


@kernel
def nearest(piece: Floats, wall: Floats) -> tuple[float, float, float]:
    """Vector from a wall (4,) to a piece (4,) between their nearest points, and its length; 0 if they cross."""
    best, best_x, best_y = np.inf, 0.0, 0.0
    for turn in range(2):
        points, line = (piece, wall) if turn == 0 else (wall, piece)
        x, y = line[2] - line[0], line[3] - line[1]
        squared = max(x * x + y * y, 1e-300)
        for end in range(2):
            px, py = points[2 * end] - line[0], points[2 * end + 1] - line[1]
            share = min(max((px * x + py * y) / squared, 0.0), 1.0)
            away_x, away_y = px - share * x, py - share * y
            distance = np.hypot(away_x, away_y)
            if distance < best:
                sign = 1.0 if turn == 0 else -1.0
                best, best_x, best_y = distance, sign * away_x, sign * away_y
    x, y = wall[2] - wall[0], wall[3] - wall[1]
    sides = (x * (piece[1] - wall[1]) - y * (piece[0] - wall[0])) * (
        x * (piece[3] - wall[1]) - y * (piece[2] - wall[0])
    )
    x, y = piece[2] - piece[0], piece[3] - piece[1]
    ends = (x * (wall[1] - piece[1]) - y * (wall[0] - piece[0])) * (x * (wall[3] - piece[1]) - y * (wall[2] - piece[0]))
    if sides < 0 and ends < 0:
        return 0.0, 0.0, 0.0
    return best_x, best_y, best


@kernel
def room_before(piece: Floats, wall: Floats, normal: Floats, reach: float) -> float:
    """Distance along a unit `normal` (2,) from the part of a wall within reach, measured across it, up to a piece."""
    across_x, across_y = -normal[1], normal[0]
    a = across_x * piece[0] + across_y * piece[1]
    b = across_x * piece[2] + across_y * piece[3]
    first = across_x * wall[0] + across_y * wall[1]
    speed = across_x * wall[2] + across_y * wall[3] - first
    low, high = min(a, b) - reach, max(a, b) + reach
    enter, leave = 0.0, 1.0
    if speed == 0.0:
        if first < low or first > high:
            return np.inf
    else:
        one, two = (low - first) / speed, (high - first) / speed
        enter, leave = max(0.0, min(one, two)), min(1.0, max(one, two))
        if enter > leave:
            return np.inf
    front = normal[0] * wall[0] + normal[1] * wall[1]
    rise = normal[0] * wall[2] + normal[1] * wall[3] - front
    top = max(front + enter * rise, front + leave * rise)
    here = min(normal[0] * piece[0] + normal[1] * piece[1], normal[0] * piece[2] + normal[1] * piece[3])
    return float(here - top)


@kernel
def _missing_wall(polar: Floats, radius: float, piece: Floats, wall: Floats, reach: float) -> Floats:
    """Headings at which a robot that slides along a piece misses a wall, by any of the separating lines."""
    pieces, legal, normal = np.empty((6 * MOST, 2)), np.empty((MOST, 2)), np.empty(2)
    x, y, distance = nearest(piece, wall)
    count = 0
    for k in range(6):
        if k == 0:
            normal[0], normal[1] = x, y
        elif k == 1:
            normal[0], normal[1] = wall[1] - wall[3], wall[2] - wall[0]
        elif k % 2 == 0:
            sign = 1.0 if k == 2 else -1.0
            normal[0], normal[1] = sign * (piece[1] - piece[3]), sign * (piece[2] - piece[0])
        else:
            sign = 1.0 if k == 3 else -1.0
            normal[0], normal[1] = sign * (piece[2] - piece[0]), sign * (piece[3] - piece[1])
        length = np.hypot(normal[0], normal[1])
        if distance == 0.0 or length == 0.0:
            continue
        normal[0] /= length
        normal[1] /= length
        room = distance if k == 0 else room_before(piece, wall, normal, reach)
        if room <= radius:
            continue
        found = _beside_line(polar, np.arctan2(normal[1], normal[0]), room - radius, legal)
        for each in range(found):
            pieces[count, 0], pieces[count, 1] = legal[each, 0], legal[each, 1]
            count += 1
        if found == 1 and legal[0, 1] - legal[0, 0] == CIRCLE:
            break
    return _united(pieces, count)


@compiled
def legal_along(polar: Floats, radius: float, piece: Floats, ends: Floats, margin: float) -> Floats:
    """Headings (k, 2) that are legal all along a piece (4,), which may be a point, among the walls `ends` (m, 4).

    polar: (v, 2) distance and angle of the robot's corners; radius: by which it is rounded.
    """
    reach = radius + margin
    for k in range(polar.shape[0]):
        reach = max(reach, polar[k, 0] + radius + margin)
    legal = np.empty((1, 2))
    legal[0, 0], legal[0, 1] = 0.0, CIRCLE
    low_x, high_x = min(piece[0], piece[2]) - reach, max(piece[0], piece[2]) + reach
    low_y, high_y = min(piece[1], piece[3]) - reach, max(piece[1], piece[3]) + reach
    for k in range(ends.shape[0]):
        wall = ends[k]
        if min(wall[0], wall[2]) > high_x or max(wall[0], wall[2]) < low_x:
            continue
        if min(wall[1], wall[3]) > high_y or max(wall[1], wall[3]) < low_y:
            continue
        if nearest(piece, wall)[2] < reach:
            legal = intersected(legal, _missing_wall(polar, radius + margin, piece, wall, reach))
            if legal.shape[0] == 0:
                break
    return legal
