"""Folders of wheel ticks and scans: a two-wheeled robot's `*_motors.txt` beside its lidar's `*_scan.txt`.

The facts below are those of the robot that writes these files: a LEGO base under a Hokuyo URG-04LX.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from frontend.scan import Floats, Scan, Sensor
from slam.readers.latency import lag, straighten, turns_seen
from slam.readers.recording import Recording, RecordingError
from slam.readers.sieve import LineError, Sieve, in_time, numbers

METRES_PER_TICK = 0.349e-3
WHEEL_BASE = 0.173
FIELD = np.radians(240.0)  # that the scanner's beams share evenly, however many a line holds
SECONDS_PER_RADIAN = 0.1 / (2 * np.pi)  # the scanner's mirror turns ten times a second
SCANNER = Sensor("lidar", max_range=4.0, min_range=0.02, range_noise=0.01, quantum=0.001, mount=(0.03, 0.0, 0.0))


@dataclass(frozen=True, eq=False)
class Wheels:
    """Dead-reckoned poses (m, 3), headings unwrapped, at times (m,) in seconds."""

    times: Floats
    poses: Floats

    def at(self, times: Floats) -> Floats:
        """Poses (n, 3) at any times (n,)."""
        return np.column_stack([np.interp(times, self.times, self.poses[:, axis]) for axis in range(3)])


def read_wheel_ticks(folder: Path, strict: bool) -> Recording:
    """The drive, dead-reckoned from (0, 0, 0); each scan straightened, with the odometry of the moment it was made."""
    motors = Sieve(_only(folder, "*_motors.txt"), strict=strict)
    ticks = np.array(list(motors.through(motors.lines(), _ticks)))
    motors.check()
    times, poses = ticks[:, 0], dead_reckon(ticks[:, 1:] * METRES_PER_TICK, WHEEL_BASE)
    if (np.diff(times) < 0).any():
        line = int(np.argmax(np.diff(times) < 0)) + 2
        raise RecordingError(f"{motors.path.name} line {line}: time {times[line - 1]:.0f} ms is before the last")
    # Several counts of one millisecond: the last one holds.
    last = np.append(np.diff(times) > 0, True)

    sieve = Sieve(_only(folder, "*_scan.txt"), strict=strict)
    arrived = list(sieve.through(sieve.lines(), in_time(_scan)))
    sieve.check()
    scans = straightened(arrived, Wheels(times[last] / 1000, poses[last]))
    return Recording(sieve.path.name.removesuffix("_scan.txt"), scans, tuple(motors.damaged + sieve.damaged))


def straightened(arrived: list[Scan], wheels: Wheels) -> tuple[Scan, ...]:
    """The scans at the middle of their sweeps, by the wheels' clock, as if the robot had stood still."""
    beams = min(scan.ranges.size for scan in arrived)
    arrivals = np.array([scan.time for scan in arrived])
    turns = turns_seen(np.array([scan.ranges[:beams] for scan in arrived]), FIELD / beams)
    times = arrivals - lag(arrivals, turns, wheels.times, wheels.poses[:, 2])
    scans = []
    for scan, time, pose in zip(arrived, times, wheels.at(times), strict=True):
        sweep = wheels.at(time + SECONDS_PER_RADIAN * scan.bearings)
        bearings, ranges = straighten(scan.bearings, scan.ranges, sweep, pose, SCANNER.mount[0])
        scans.append(Scan(bearings, ranges, SCANNER, pose, float(time)))
    return tuple(scans)


def dead_reckon(travelled: Floats, wheel_base: float) -> Floats:
    """Poses (n, 3) of a two-wheeled robot from its left and right wheels' travelled metres (n, 2), along arcs.

    The first pose is (0, 0, 0). Headings are not wrapped, so that they can be interpolated.
    """
    left, right = np.diff(travelled, axis=0).T
    turns = (right - left) / wheel_base
    headings = np.concatenate([[0.0], np.cumsum(turns)])
    # The chord of an arc is shorter than the arc by sin(turn/2) / (turn/2).
    chords = (left + right) / 2 * np.sinc(turns / (2 * np.pi))
    middles = headings[:-1] + turns / 2
    places = np.cumsum(np.column_stack([chords * np.cos(middles), chords * np.sin(middles)]), axis=0)
    return np.column_stack([np.vstack([np.zeros((1, 2)), places]), headings])


def _only(folder: Path, pattern: str) -> Path:
    found = sorted(folder.glob(pattern))
    if len(found) != 1:
        raise RecordingError(f"{folder} holds {len(found)} files {pattern}, but needs exactly one")
    return found[0]


def _ticks(text: str) -> Floats:
    """M, milliseconds, left ticks, three other counts, right ticks, …: time and the two counts (3,)."""
    fields = text.split()
    if len(fields) < 7 or fields[0] != "M":
        raise LineError(f"{len(fields)} fields beginning {fields[:1]}, but 'M' and at least six counts are needed")
    return numbers([fields[1], fields[2], fields[6]])


def _scan(text: str) -> Scan:
    """S, milliseconds, n, n ranges in millimetres: the scan as it arrived, not yet beside the wheels."""
    fields = text.split()
    if len(fields) < 3 or fields[0] != "S":
        raise LineError(f"{len(fields)} fields beginning {fields[:1]}, but 'S', a time and a count are needed")
    moment, announced = numbers(fields[1:3])
    if len(fields) - 3 != announced:
        raise LineError(f"{len(fields) - 3} ranges, but {announced:.0f} are announced")
    metres = numbers(fields[3:]) / 1000
    if (metres < 0).any() or np.isnan(metres).any():
        raise LineError("a range is negative or NaN")
    # Below the scanner's least range it writes error codes.
    ranges = np.where(metres < SCANNER.min_range, np.nan, metres)
    bearings = FIELD / ranges.size * (np.arange(ranges.size, dtype=np.float64) - ranges.size // 2)
    return Scan(bearings, ranges, SCANNER, np.zeros(3), float(moment) / 1000)
