"""Redrawing: which silent gaps of the infrared are openings, and the arc drawn in each (Flynn 1988, §3.3)."""

import numpy as np

from frontend.infrared_edges import InfraredEdge, Opening
from frontend.scan import Booleans, Floats, Scan
from frontend.wall_lines import Profile, wall_beside

# Of the stated half-beam: the beam of a surface 12 dB brighter than the faintest that is reckoned with.
BRIGHT_SHARE = 2.0


def why_closed(opening: Opening, profile: Profile, scan: Scan, door_depth: float) -> str | None:
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
    ends = [_wall_end(edge, profile, scan) for edge in (opening.right, opening.left)]
    for wall in ends:
        # A wall that would lie well beyond the horizon is not the one the infrared felt at the edge.
        if abs(horizon - wall) < door_depth:
            return f"the wall is {wall:.2f} m away at the edge, where the infrared fades out by itself"
    if min(ends) > horizon:
        return f"no wall ends beside it: they run on to {min(ends):.2f} m, beyond the infrared's range"
    return None


def _wall_end(edge: InfraredEdge, profile: Profile, scan: Scan) -> float:
    """How far away the wall beside an edge is at the edge, metres.

    In a corner the beam reads short, so where the infrared fades out there it seems to do so before its range: the
    wall is continued from where it is read as it is. Where that lies farther than a square corner can shorten it to
    the reading, it is another wall, and the reading stands.
    """
    noise = float(np.hypot(scan.sensor.range_noise, scan.sensor.quantum))
    reading = float(profile.ranges[edge.jamb])
    wall = wall_beside(profile, edge.jamb, -1 if edge.opens else 1, noise)
    if wall is None:
        return reading
    continued = float(wall.ranges(np.array([edge.bearing]))[0][0])
    beam = BRIGHT_SHARE * scan.sensor.half_beam_at(reading)
    shortest = continued * np.sin(np.pi / 4) / np.sin(np.pi / 4 + min(beam, np.pi / 4))
    return continued if reading > shortest - 4 * noise else reading


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
    """Ranges (w,) between the jambs: the infrared's horizon or the opened sonar range there, whichever is farther.

    The paper draws one arc at the farthest echo of the whole opening. One far echo says nothing outside its own beam:
    from within a doorway that arc would reach deep into the walls on both sides.
    """
    horizon = scan.sensor.infrared_range
    assert horizon is not None
    return np.maximum(ranges[opening.readings], horizon)
