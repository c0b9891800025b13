"""Redrawing: which silent gaps of the infrared are openings, and the arc drawn in each (Flynn 1988, §3.3)."""

import numpy as np

from frontend.infrared_edges import InfraredEdge, Opening
from frontend.scan import Booleans, Floats, Scan

# Of the stated half-beam: the beam of a surface 12 dB brighter than the faintest that is reckoned with.
BRIGHT_SHARE = 2.0


def why_closed(opening: Opening, ranges: Floats, scan: Scan, door_depth: float) -> str | None:
    """Why the infrared's silence between two edges is no opening, or None when it is one."""
    horizon = scan.sensor.infrared_range
    assert horizon is not None
    width = _gap(opening)
    core = opening.readings[gap_core(opening, scan)]
    looked = core[np.isfinite(scan.ranges[core])]
    if looked.size and np.min(scan.ranges[looked]) < horizon:
        return (
            f"the sonar sees a surface {np.min(scan.ranges[looked]):.2f} m away inside the {np.degrees(width):.0f}° gap"
        )
    for edge in (opening.right, opening.left):
        wall = max(float(ranges[edge.jamb]), _wall_range(edge, ranges, scan))
        # A wall that would lie well beyond the horizon is not the one the infrared felt at the edge.
        if abs(horizon - wall) < door_depth:
            return f"the wall is {wall:.2f} m away at the edge, where the infrared fades out by itself"
    return None


def _wall_range(edge: InfraredEdge, ranges: Floats, scan: Scan) -> float:
    """How far the wall beside an edge would be at the edge, 0 where no straight wall leads there.

    In a corner the beam reads short, so where the infrared fades out there it seems to do so before its range: the
    wall is taken from one to two half-beams aside, where it is read as it is.
    """
    half_beam = scan.sensor.half_beam_at(float(ranges[edge.jamb]))
    step = float(np.median(np.diff(scan.bearings)))
    aside = np.arange(int(np.ceil(2 * half_beam / step)) + 1)
    places = edge.jamb + (-aside if edge.opens else aside)
    if not scan.full_turn and not (places.min() >= 0 and places.max() < ranges.size):
        return 0.0
    reach = ranges[places % ranges.size]
    bearings = scan.bearings[places % ranges.size] - edge.bearing
    straight = slice(int(np.ceil(half_beam / step)), None)
    # A line's inverse range is linear in the cosine and sine of the bearing.
    rays = np.column_stack([np.cos(bearings), np.sin(bearings)])[straight]
    line, *_ = np.linalg.lstsq(rays, 1 / reach[straight], rcond=None)
    misses = np.abs(reach[straight] - 1 / np.maximum(rays @ line, 1e-6))
    is_wall = np.max(misses, initial=0.0) < 4 * scan.sensor.range_noise + scan.sensor.quantum
    return float(1 / line[0]) if is_wall and line[0] > 0 else 0.0


def _gap(opening: Opening) -> float:
    return float(np.mod(opening.left.bearing - opening.right.bearing, 2 * np.pi))


def gap_core(opening: Opening, scan: Scan) -> Booleans:
    """Which readings (w,) of the opening have their whole beam inside it.

    The stated half-beam is what surely is heard; a bright jamb is heard from about twice as far off the axis.
    """
    from_right = np.mod(scan.bearings[opening.readings] - opening.right.bearing, 2 * np.pi)
    right, left = (
        BRIGHT_SHARE * scan.sensor.half_beam_at(float(scan.ranges[edge.jamb])) for edge in (opening.right, opening.left)
    )
    return np.asarray((from_right > right) & (from_right < _gap(opening) - left))


def opening_arc(opening: Opening, ranges: Floats, scan: Scan) -> Floats:
    """Ranges (w,) of the arc: the infrared's horizon or the farthest echo, whichever is farther.

    A gap wider than the beam lets the sonar look through, so there each bearing keeps its own opened range where that
    is farther: one far echo in the middle says nothing of the sides.
    """
    horizon = scan.sensor.infrared_range
    assert horizon is not None
    own = ranges[opening.readings]
    if np.any(gap_core(opening, scan)):
        return np.maximum(own, horizon)
    return np.full(own.size, max(horizon, float(np.max(own))))
