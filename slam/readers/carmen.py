"""CARMEN logs: text lines FLASER or ROBOTLASER1, each a lidar scan with the odometry at that moment."""

import re
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from frontend.scan import Floats, Scan, Sensor
from slam.readers.recording import DamagedLine, Recording, RecordingError
from slam.readers.sieve import LineError, Sieve, in_time, numbers, refuse_impossible
from slam.trajectory_file import Trajectory

# Logs print microseconds at best and were written in bursts: scans of one stamp are told apart by this much, seconds.
TIE_STEP = 1e-5
# A no-return value comes up this many times as often as any smaller reading in the far half of the range.
SATURATION = 10
UNKNOWN_LASER = Sensor("lidar", max_range=np.inf)


def read_carmen(path: Path, strict: bool) -> Recording:
    """The log's front-laser scans with raw odometry; readings at or over the no-return value become inf, zeros nan."""
    sieve = Sieve(path, strict=strict)
    lines = [(number, text) for number, text in sieve.lines() if text.strip() and not text.startswith("#")]
    keyword = next((text.split(" ", 1)[0] for _, text in lines if text.startswith(tuple(PARSERS))), "")
    if keyword not in PARSERS:
        raise RecordingError(f"{path}: no line of {' or '.join(PARSERS)}, so this is no CARMEN log with scans")
    parse = in_time(partial(PARSERS[keyword], strict=strict), repeats=not strict)
    scans = list(sieve.through([(n, text) for n, text in lines if _concerns(text, keyword)], parse))
    sieve.check()
    times, ties = tell_ties_apart(np.array([scan.time for scan in scans]))
    if ties:
        sieve.note(
            lines[0][0], f"{ties} scans repeat the time before theirs, each is moved on by {TIE_STEP * 1e6:.0f} µs"
        )
    sensor = Sensor("lidar", max_range=_limit(scans, path), mount=(_front_laser_offset(lines), 0.0, 0.0))
    seen = [_with_returns(scan, sensor, time) for scan, time in zip(scans, times.tolist(), strict=True)]
    trail, damaged = _odometry(lines, seen, path, strict)
    return Recording(path.name.split(".")[0], tuple(seen), (*sieve.damaged, *damaged), odometry=trail)


def no_return_value(ranges: Floats) -> float:
    """The reading at and above which the scanner says that nothing came back; its farthest reading if it never does.

    A scanner repeats one far value for every beam without an echo; real distances that far are spread over many values.
    """
    usable = ranges[np.isfinite(ranges)]
    values, counts = np.unique(usable[usable > usable.max() / 2], return_counts=True)
    most = int(np.argmax(counts))
    stands_out = counts[most] >= SATURATION * (1 + counts[:most].max(initial=0))
    # Error codes may lie above it, but they are fewer.
    if stands_out and counts[most] > 2 * counts[most + 1 :].sum():
        return float(values[most])
    return float(np.nextafter(values[-1], np.inf))


def half_turn_bearings(beams: int) -> Floats:
    """The bearings of a scanner that looks over 180°, from right to left.

    Odd counts (181, 361) reach from −90° to +90° in whole or half degrees; an even count (180, 360) keeps the step of
    the scanner and lacks the last beam, for steps of 180°/179 exist in no device.
    """
    step = np.pi / (beams if beams % 2 == 0 else max(beams - 1, 1))
    return -np.pi / 2 + step * np.arange(beams, dtype=np.float64)


def tell_ties_apart(times: Floats) -> tuple[Floats, int]:
    """Times (n,) made strictly increasing by moving each repeat on from the one before it, and how many repeats."""
    repeats = np.diff(times, prepend=-np.inf) == 0
    starts = np.maximum.accumulate(np.where(repeats, 0, np.arange(times.size)))
    return times + TIE_STEP * (np.arange(times.size) - starts), int(repeats.sum())


def _flaser(text: str, strict: bool) -> Scan:
    """FLASER n, n ranges, laser pose (3), odometry (3), time, host, logger time."""
    fields = text.split()
    beams = _count(fields, 1)
    if len(fields) != 2 + beams + 9:
        raise LineError(f"{beams} ranges are announced, but {len(fields) - 11} stand between count and poses")
    ranges = _ranges(fields[2 : 2 + beams], strict)
    odometry = _finite(fields[-6:-3])
    return Scan(half_turn_bearings(beams), ranges, UNKNOWN_LASER, odometry, float(_finite(fields[-3:-2])[0]))


def _robotlaser(text: str, strict: bool) -> Scan:
    """ROBOTLASER1 type, start, field of view, step, maximum, accuracy, remission mode, n, n ranges, m, m remissions,
    laser pose (3), odometry (3), five numbers of the robot, time, host, logger time."""
    fields = text.split()
    beams = _count(fields, 8)
    remissions = _count(fields, 9 + beams)
    expected = 10 + beams + remissions + 14
    if len(fields) != expected:
        raise LineError(
            f"{beams} ranges and {remissions} remissions make {expected} fields, but there are {len(fields)}"
        )
    start, _, step, maximum = _finite(fields[2:6])
    ranges = _ranges(fields[9 : 9 + beams], strict)
    bearings = start + step * np.arange(beams, dtype=np.float64)
    laser = Sensor("lidar", max_range=float(maximum))
    return Scan(bearings, ranges, laser, _finite(fields[-11:-8]), float(_finite(fields[-3:-2])[0]))


PARSERS = {"FLASER": _flaser, "ROBOTLASER1": _robotlaser}


def _odometry(
    lines: list[tuple[int, str]], scans: list[Scan], path: Path, strict: bool
) -> tuple[Trajectory | None, list[DamagedLine]]:
    """Every ODOM line (x, y, heading, two speeds, acceleration, time) among the scans' own odometry, by time.

    Also the damaged lines; None where the log has no ODOM line.
    """
    sieve = Sieve(path, strict=strict)
    rows = list(sieve.through([(n, text) for n, text in lines if text.startswith("ODOM ")], _odom))
    if not rows:
        return None, sieve.damaged
    # A scan's own odometry comes first, so that it holds where an ODOM line has the same time.
    places = np.array([*([*scan.odometry, scan.time] for scan in scans), *rows])
    times, kept = np.unique(places[:, 3], return_index=True)
    return Trajectory(times, places[kept, :2], places[kept, 2]), sieve.damaged


def _odom(text: str) -> Floats:
    fields = text.split()
    if len(fields) < 8:
        raise LineError(f"ODOM has {len(fields) - 1} values, but needs a pose, three speeds and a time")
    return _finite([*fields[1:4], fields[7]])


def _concerns(text: str, keyword: str) -> bool:
    """Whether the line is one of ours, or no CARMEN message at all and therefore damage."""
    word = text.split(" ", 1)[0]
    return word == keyword or not re.fullmatch(r"[A-Z][A-Z0-9_-]*", word)


def _count(fields: list[str], place: int) -> int:
    if place >= len(fields) or not fields[place].isdecimal():
        raise LineError(f"{fields[place][:40]!r} is not a count" if place < len(fields) else "the line breaks off")
    return int(fields[place])


def _finite(fields: list[str]) -> Floats:
    values = numbers(fields)
    if not np.isfinite(values).all():
        raise LineError(f"{fields[int(np.argmin(np.isfinite(values)))]} is no place or time")
    return values


def _ranges(fields: list[str], strict: bool) -> Floats:
    """The ranges; drivers write zero for a reading that failed, which is nan unless in strict mode."""
    if not fields:
        raise LineError("a scan of 0 ranges")
    ranges = numbers(fields)
    refuse_impossible(ranges if strict else ranges[ranges != 0])
    return np.where(ranges == 0, np.nan, ranges)


def _limit(scans: list[Scan], path: Path) -> float:
    """The scanner's maximum range: as the lines say, else as the readings tell."""
    if np.isfinite(scans[0].sensor.max_range):
        return scans[0].sensor.max_range
    ranges = np.concatenate([scan.ranges for scan in scans])
    if not np.isfinite(ranges).any():
        raise RecordingError(f"{path}: not one echo in {len(scans)} scans")
    return no_return_value(ranges)


def _front_laser_offset(lines: list[tuple[int, str]]) -> float:
    """How far ahead of the robot's centre the scanner sits, metres: from the log's parameters, else 0."""
    given = [text.split() for _, text in lines if text.startswith("PARAM robot_frontlaser_offset ")]
    return float(numbers(given[-1][2:3])[0]) if given else 0.0


def _with_returns(scan: Scan, sensor: Sensor, time: float) -> Scan:
    ranges = np.where(scan.ranges >= sensor.max_range, np.inf, scan.ranges)
    return replace(scan, ranges=ranges, sensor=sensor, time=time)
