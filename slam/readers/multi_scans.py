"""Multi-scans: few fixed beams gathered along the way into scans that show enough to be recognised.

Over a few metres the odometry is as good as a reading, so readings along a piece of the way are laid together in the
frame of its middle. Pieces overlap: each shows again what its neighbours show.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from frontend.rigid_motion import between, transform
from frontend.scan import Floats, Scan, Sensor
from slam.readers.recording import OdometryNoise

PIECE = 4.0  # metres of way in one multi-scan; longer shows more and trusts the odometry more
STEP = 0.5  # metres of way, or
TURN = 0.5  # radians of turn, from one multi-scan to the next
BEARINGS = np.radians(np.arange(-178.5, 180, 3.0))  # as fine as four beams fill a piece of a corridor
DRIFT = 0.01  # metres of odometry error per metre of way, added to the noise of a reading
# The same as a fact of the robot: the way between multi-scans is trusted as far as the way within them, which
# neighbours share, so that registration could only say it again.
ODOMETRY = OdometryNoise(distance_noise=DRIFT, turn_noise=DRIFT, turn_per_metre_noise=DRIFT)


def gathered(scans: Sequence[Scan]) -> tuple[Scan, ...]:
    """Multi-scans at the scans where the robot has gone or turned far enough; the odometry there stays raw."""
    poses = np.array([scan.odometry for scan in scans])
    moves = np.diff(poses, axis=0)
    way = np.append(0.0, np.cumsum(np.hypot(moves[:, 0], moves[:, 1])))
    turned = np.append(0.0, np.cumsum(np.abs(np.arctan2(np.sin(moves[:, 2]), np.cos(moves[:, 2])))))
    found, last = [], -1
    for middle in range(len(scans)):
        if last >= 0 and way[middle] - way[last] < STEP and turned[middle] - turned[last] < TURN:
            continue
        first, after = np.searchsorted(way, [way[middle] - PIECE / 2, way[middle] + PIECE / 2 + 1e-9])
        found.append(_together(scans[first:after], scans[middle]))
        last = middle
    return tuple(found)


def _together(piece: Sequence[Scan], middle: Scan) -> Scan:
    """The nearest echo in each direction from where the middle scan stood."""
    ends = np.concatenate([transform(_ends(scan), between(middle.odometry, scan.odometry)) for scan in piece])
    step = BEARINGS[1] - BEARINGS[0]
    sectors = np.floor((np.arctan2(ends[:, 1], ends[:, 0]) - BEARINGS[0]) / step + 0.5).astype(np.int64) % BEARINGS.size
    ranges = np.full(BEARINGS.size, np.inf)
    np.minimum.at(ranges, sectors, np.hypot(ends[:, 0], ends[:, 1]))
    # Where no beam pointed nothing is known: it is no free space.
    return replace(middle, bearings=BEARINGS, ranges=np.where(np.isinf(ranges), np.nan, ranges), sensor=_seer(middle))


def _ends(scan: Scan) -> Floats:
    seen = np.isfinite(scan.ranges)
    rays = np.column_stack([np.cos(scan.bearings[seen]), np.sin(scan.bearings[seen])])
    return transform(scan.ranges[seen, None] * rays, np.array(scan.sensor.mount))


def _seer(scan: Scan) -> Sensor:
    """The facts of a sensor that would have seen a multi-scan from its middle."""
    noise = float(np.hypot(scan.sensor.range_noise, DRIFT * PIECE / 2))
    reach = scan.sensor.max_range + PIECE / 2
    return replace(scan.sensor, max_range=reach, half_beam=0.0, range_noise=noise, mount=(0.0, 0.0, 0.0))
