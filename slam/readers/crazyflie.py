"""Crazyflie logs: CSV of a nano-drone with four time-of-flight beams, `t,x,y,z,yaw,right,front,left,back,up`."""

import math
from pathlib import Path

import numpy as np

from frontend.scan import Scan, Sensor
from slam.readers.multi_scans import ODOMETRY, gathered
from slam.readers.recording import Recording, RecordingError
from slam.readers.sieve import LineError, Sieve, in_time, numbers, refuse_impossible
from slam.trajectory_file import Trajectory

COLUMNS = "t,x,y,z,yaw,right,front,left,back,up"
BEARINGS = np.radians([-90.0, 0.0, 90.0, 180.0])
# The VL53L1x reports up to 4 m, but beyond 2 m it misses dark and slanted surfaces: nothing there is trusted.
RANGER = Sensor("time_of_flight", max_range=2.0, min_range=0.04, half_beam=math.radians(13.5), range_noise=0.025)


def read_crazyflie(path: Path, strict: bool) -> Recording:
    """The flight as multi-scans of its four beams; the drone's own drifting estimate is its odometry."""
    sieve = Sieve(path, strict=strict)
    lines = sieve.lines()
    _, header = next(lines, (1, ""))
    if header != COLUMNS:
        raise RecordingError(f"{path.name} line 1: the header is {header[:60]!r}, but should be {COLUMNS!r}")
    scans = tuple(sieve.through(lines, in_time(_row)))
    sieve.check()
    poses, times = np.array([scan.odometry for scan in scans]), np.array([scan.time for scan in scans])
    trail = Trajectory(times, poses[:, :2], poses[:, 2])
    return Recording(path.name.split(".")[0], gathered(scans), tuple(sieve.damaged), ODOMETRY, trail)


def _row(text: str) -> Scan:
    fields = text.split(",")
    if len(fields) != 10:
        raise LineError(f"{len(fields)} fields, but {COLUMNS} are ten")
    row = numbers(fields)
    ranges = row[5:9]
    refuse_impossible(ranges)
    if not np.isfinite(row).all():
        raise LineError("a time or place is not finite")
    seen = np.where(ranges >= RANGER.max_range, np.inf, ranges)
    return Scan(BEARINGS, seen, RANGER, row[[1, 2, 4]], float(row[0]))
