"""Straight ways from a pose, with the headings that are legal on them: the first piece of every way in."""

import numpy as np
from numpy.typing import NDArray

from planners.circular import joined, shared
from planners.compiled import compiled, kernel
from planners.orientations import intersected, legal_along, nearest
from planners.slices import Body

Floats = NDArray[np.float64]

STEPS = 10  # numbers that hold the five arcs of a departure


@kernel
def _way(body: Body, piece: Floats) -> tuple[Floats, Floats, Floats]:
    """Legal arcs all along a piece (4,), on its first and on its last slice."""
    total = max(1, int(np.ceil(np.hypot(piece[2] - piece[0], piece[3] - piece[1]) / body.step)))
    part = np.empty(4)
    everywhere = first = last = np.empty((0, 2))
    for each in range(total):
        for axis in range(2):
            rise = piece[2 + axis] - piece[axis]
            part[axis] = piece[axis] + rise * each / total
            part[2 + axis] = piece[axis] + rise * (each + 1) / total
        last = legal_along(body.polar, body.radius, part, body.ends, body.margin)
        everywhere = last if each == 0 else intersected(everywhere, last)
        if each == 0:
            first = last
        if everywhere.shape[0] == 0:
            break
    return joined(everywhere), joined(first), joined(last)


@kernel
def cost_of(body: Body, piece: Floats) -> float:
    """Length of a piece (4,), times up to 1 + caution where it is tight."""
    room = body.width
    low_x, high_x = min(piece[0], piece[2]) - room, max(piece[0], piece[2]) + room
    low_y, high_y = min(piece[1], piece[3]) - room, max(piece[1], piece[3]) + room
    for k in range(body.ends.shape[0]):
        wall = body.ends[k]
        if min(wall[0], wall[2]) > high_x or max(wall[0], wall[2]) < low_x:
            continue
        if min(wall[1], wall[3]) > high_y or max(wall[1], wall[3]) < low_y:
            continue
        room = min(room, nearest(piece, wall)[2])
    tightness = min(max(2 - 2 * room / body.width, 0.0), 1.0)
    return float(np.hypot(piece[2] - piece[0], piece[3] - piece[1]) * (1 + body.caution * tightness))


@compiled
def common(first: Floats, second: Floats) -> Floats:
    """Rows (c, 6): every arc shared by an arc of the first set and one of the second, then those two."""
    rows, count, both = np.empty((2 * first.shape[0] * second.shape[0], 6)), 0, np.empty((2, 2))
    for one in range(first.shape[0]):
        for two in range(second.shape[0]):
            for k in range(shared(first[one, 0], first[one, 1], second[two, 0], second[two, 1], both)):
                for side in range(2):
                    rows[count, side], rows[count, 2 + side] = both[k, side], first[one, side]
                    rows[count, 4 + side] = second[two, side]
                count += 1
    return rows[:count].copy()


@compiled
def standing_arcs(body: Body, pose: Floats) -> Floats:
    """Legal arcs (k, 2) at a pose (3,): those that hold its heading, or all if that is nan."""
    piece = np.empty(4)
    for axis in range(2):
        piece[axis] = piece[2 + axis] = pose[axis]
    arcs, count = _way(body, piece)[0].copy(), 0
    for k in range(arcs.shape[0]):
        if np.isnan(pose[2]) or (pose[2] - arcs[k, 0]) % (2 * np.pi) <= arcs[k, 1] - arcs[k, 0]:
            arcs[count, 0], arcs[count, 1] = arcs[k, 0], arcs[k, 1]
            count += 1
    return arcs[:count].copy()


@compiled
def departures(body: Body, here: Floats, piece: Floats) -> tuple[Floats, float]:
    """Ways straight along a piece (4,), and their cost: rows (d, STEPS).

    Their arcs are: where the robot stands (one of `here`), what it turns to on the spot, the first slice's arc, what is
    legal all the way, the last slice's arc.
    """
    along, first, last = _way(body, piece)
    rows, count = np.empty((4, STEPS)), 0
    turned = common(here, first)
    for t in range(turned.shape[0]):
        legs = common(along, turned[t : t + 1, 4:6].copy())
        for k in range(legs.shape[0]):
            arrived = common(last, legs[k : k + 1, 0:2].copy())
            for a in range(arrived.shape[0]):
                if count == rows.shape[0]:
                    rows = np.concatenate((rows, rows))
                for side in range(2):
                    rows[count, side], rows[count, 2 + side] = turned[t, 2 + side], turned[t, side]
                    rows[count, 4 + side], rows[count, 6 + side] = turned[t, 4 + side], legs[k, side]
                    rows[count, 8 + side] = arrived[a, 2 + side]
                count += 1
    return rows[:count].copy(), cost_of(body, piece)
