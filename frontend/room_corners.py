"""Corners of a room that a wide beam cannot see into, inferred from the two walls that run into them.

In a corner of rough walls the first echo reads short, and undoing the beam stops there too (Flynn 1988, §3.1). The
walls are measured on both sides: where both run on until they meet, where the infrared does not object, and where the
readings are no shorter than the beam makes them, that corner is the simplest room. It is inferred, never measured.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d

from frontend.redrawing import BRIGHT_SHARE
from frontend.scan import Booleans, Floats, Integers, Scan
from frontend.wall_lines import Profile, wall_beside

# Between walls that may be continued to a corner nobody saw: a smeared edge makes slanted walls, a room square ones.
SQUARE = np.radians(15.0)
INFRARED_SURE = 0.8  # of its range: there the infrared still feels a wall that it meets aslant


@dataclass(frozen=True, eq=False)
class RoomCorner:
    """An inferred corner: readings (w,) that fall short in it, and how far it reaches along each, metres (w,)."""

    readings: Integers
    ranges: Floats


def room_corners(profile: Profile, hidden: Booleans, scan: Scan) -> list[RoomCorner]:
    """The corners that walls on both sides agree on; hidden (n,): readings that may lie in one, and are no opening."""
    if scan.sensor.half_beam <= 0:
        return []
    found = [_corner_at(int(peak), profile, hidden, scan) for peak in _peaks(profile, hidden, scan)]
    return [corner for corner in found if corner is not None]


def _width(metres: float, profile: Profile, scan: Scan) -> int:
    """Readings to each side that a bright surface so far away is heard in."""
    return int(np.ceil(BRIGHT_SHARE * scan.sensor.half_beam_at(metres) / profile.step))


def _peaks(profile: Profile, hidden: Booleans, scan: Scan) -> Integers:
    """One reading (p,) of every rise of the profile: none within half a narrow beam of it is farther."""
    reach = max(_width(scan.sensor.max_range, profile, scan) // 2, 2)
    highest = (profile.ranges >= maximum_filter1d(profile.ranges, 2 * reach + 1, mode="wrap")) & hidden
    return np.flatnonzero(highest & ~np.roll(highest, 1))


def _corner_at(peak: int, profile: Profile, hidden: Booleans, scan: Scan) -> RoomCorner | None:
    noise = float(np.hypot(scan.sensor.range_noise, scan.sensor.quantum))
    n, width = profile.ranges.size, _width(float(profile.ranges[peak]), profile, scan)
    right, left = (wall_beside(profile, peak, sense, noise) for sense in (-1, 1))
    if right is None or left is None or max(right.away, left.away) > width + 1:
        return None
    if not scan.full_turn and not right.away <= peak < n - left.away:
        return None
    stretch = (peak + np.arange(1 - right.away, left.away)) % n
    turn = np.mod(left.direction - right.direction, np.pi)
    if abs(turn - np.pi / 2) > SQUARE or not np.all(hidden[stretch]):
        return None
    meeting = [wall.ranges(profile.bearings[stretch])[0] for wall in (right, left)]
    ranges = np.minimum(*meeting)
    nearer = meeting[0] < meeting[1]
    crosses = nearer.any() and not nearer.all() and bool(np.all(np.diff(nearer.astype(int)) <= 0))
    if not crosses or not _believable(stretch, ranges, profile, scan):
        return None
    short = ranges > profile.ranges[stretch] + 2 * noise
    return RoomCorner(stretch[short], ranges[short])


def _believable(stretch: Integers, ranges: Floats, profile: Profile, scan: Scan) -> bool:
    """Whether no reading reaches farther than the corner, none is shorter than a beam in it, and infrared agrees."""
    noise = 4 * float(np.hypot(scan.sensor.range_noise, scan.sensor.quantum))
    if not np.all(ranges > profile.ranges[stretch] - noise) or np.max(ranges) > scan.sensor.max_range:
        return False
    whole = profile.ranges.copy()
    whole[stretch] = ranges
    width = _width(float(np.min(ranges)), profile, scan)
    beams = whole[(stretch[:, None] + np.arange(-width, width + 1)) % whole.size]
    if np.any(scan.ranges[stretch] < np.min(beams, axis=1) - noise):
        return False
    horizon = scan.sensor.infrared_range
    if scan.infrared is None or horizon is None:
        return True
    silent = scan.infrared[stretch] % 10 == 0
    return not np.any(silent & (ranges < INFRARED_SURE * horizon))
