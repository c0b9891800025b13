"""Folders of wheel ticks and scans: a two-wheeled robot's `*_motors.txt` beside its lidar's `*_scan.txt`.

The facts below are those of the robot that writes these files: a LEGO base under a Hokuyo URG-04LX.
"""

from pathlib import Path

import numpy as np

from frontend.scan import Floats, Scan, Sensor
from slam.readers.recording import Recording, RecordingError
from slam.readers.sieve import LineError, Sieve, in_time, numbers

METRES_PER_TICK = 0.349e-3
WHEEL_BASE = 0.173
BEAM_STEP = 2 * np.pi / 1024
SCANNER = Sensor("lidar", max_range=4.0, min_range=0.02, range_noise=0.01, quantum=0.001, mount=(0.03, 0.0, 0.0))


def read_wheel_ticks(folder: Path, strict: bool) -> Recording:
    """The drive, dead-reckoned from (0, 0, 0); each scan with the odometry at its own time."""
    motors = Sieve(_only(folder, "*_motors.txt"), strict=strict)
    ticks = np.array(list(motors.through(motors.lines(), _ticks)))
    motors.check()
    times, poses = ticks[:, 0], dead_reckon(ticks[:, 1:] * METRES_PER_TICK, WHEEL_BASE)
    if (np.diff(times) < 0).any():
        line = int(np.argmax(np.diff(times) < 0)) + 2
        raise RecordingError(f"{motors.path.name} line {line}: time {times[line - 1]:.0f} ms is before the last")
    # Several counts of one millisecond: the last one holds.
    last = np.append(np.diff(times) > 0, True)

    def scan(text: str) -> Scan:
        moment, ranges = _ranges(text)
        odometry = np.array([float(np.interp(moment, times[last], poses[last, axis])) for axis in range(3)])
        bearings = BEAM_STEP * (np.arange(ranges.size, dtype=np.float64) - ranges.size // 2)
        return Scan(bearings, ranges, SCANNER, odometry, moment / 1000)

    sieve = Sieve(_only(folder, "*_scan.txt"), strict=strict)
    scans = tuple(sieve.through(sieve.lines(), in_time(scan)))
    sieve.check()
    return Recording(sieve.path.name.removesuffix("_scan.txt"), scans, tuple(motors.damaged + sieve.damaged))


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


def _ranges(text: str) -> tuple[float, Floats]:
    """S, milliseconds, n, n ranges in millimetres: milliseconds and ranges (n,) in metres."""
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
    return float(moment), np.where(metres < SCANNER.min_range, np.nan, metres)
