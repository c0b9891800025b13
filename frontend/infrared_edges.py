"""Infrared edges and the openings they pair to: where "nothing detected" meets "something" (Flynn 1988, §3.3).

The infrared finds the bearing of a jamb finely and knows no range; the sonar knows the range of the jamb and
smears its bearing. An edge takes each from where it is strong.
"""

from dataclasses import dataclass

import numpy as np

from frontend.scan import Booleans, Floats, Integers, Scan


@dataclass(frozen=True)
class InfraredEdge:
    """A change between detection and none. jamb: the reading that detects; bearing: halfway to the other.

    opens: True where the view opens counter-clockwise of the jamb (a right jamb), False where it closes.
    """

    jamb: int
    bearing: float
    opens: bool


@dataclass(frozen=True, eq=False)
class Opening:
    """A pair of edges, right and left as seen from the sensor, and the range of the arc between them.

    readings: (w,) indices strictly between the jambs, in counter-clockwise order.
    """

    right: InfraredEdge
    left: InfraredEdge
    readings: Integers


def infrared_edges(scan: Scan) -> list[InfraredEdge]:
    """Rules 1 and 3: every valid change of detection, both directions, across the wrap-around of a full turn."""
    if scan.infrared is None or scan.sensor.infrared_range is None:
        return []
    detects = scan.infrared % 10 > 0
    following = np.roll(np.arange(detects.size), -1)
    changes = detects != detects[following]
    if not scan.full_turn:
        changes[-1] = False
    edges = []
    for i in np.flatnonzero(changes):
        opens = bool(detects[i])
        jamb = int(i if opens else following[i])
        # Rule 1: beyond its range the infrared is not believed, so what it detects there is no jamb.
        if scan.ranges[jamb] < scan.sensor.infrared_range:
            edges.append(InfraredEdge(jamb, _bearing_between(scan.bearings, int(i)), opens))
    return edges


def pair_edges(edges: list[InfraredEdge], scan: Scan) -> tuple[list[Opening], list[InfraredEdge]]:
    """Openings (an opening edge and the next edge, if that closes) and the lone edges that remain."""
    openings, paired = [], set()
    for k, right in enumerate(edges):
        left = edges[(k + 1) % len(edges)]
        wraps = k + 1 == len(edges)
        if right.opens and not left.opens and (scan.full_turn or not wraps):
            inside = _readings_between(right.jamb, left.jamb, scan.ranges.size)
            if inside.size and not np.any(_detected(scan, inside)):
                openings.append(Opening(right, left, inside))
                paired |= {k, (k + 1) % len(edges)}
    return openings, [edge for k, edge in enumerate(edges) if k not in paired]


def _detected(scan: Scan, readings: Integers) -> Booleans:
    assert scan.infrared is not None
    assert scan.sensor.infrared_range is not None
    return (scan.infrared[readings] % 10 > 0) & (scan.ranges[readings] < scan.sensor.infrared_range)


def _readings_between(right: int, left: int, n: int) -> Integers:
    return (right + 1 + np.arange((left - right - 1) % n)) % n


def _bearing_between(bearings: Floats, i: int) -> float:
    """Halfway from reading i to the next, counter-clockwise, also across the wrap-around."""
    step = np.mod(bearings[(i + 1) % bearings.size] - bearings[i], 2 * np.pi)
    return float(bearings[i] + step / 2)
