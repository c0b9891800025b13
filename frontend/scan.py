"""A scan: what the head saw in one turn, with the facts of the sensor that saw it (Flynn 1988, §3)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]


class ScanError(Exception):
    """A scan whose arrays do not fit together; the message carries the numbers."""


@dataclass(frozen=True, eq=False)
class Sensor:
    """Facts of one sensor, from `recording.toml`; opinions live in settings.

    kind: "sonar_infrared", "lidar" or "time_of_flight". Metres and radians throughout.
    half_beam: how far off its axis the sensor surely hears a surface at any range. half_beams: the same range by range,
    pairs of metres and radians from near to far, where it is known: a near surface is heard much farther off the axis.
    mount: pose (3,) of the sensor in the robot's frame. infrared_range: how far the infrared
    detects at most (10 ft with three LEDs); None without an infrared detector.
    """

    kind: str
    max_range: float
    min_range: float = 0.0
    half_beam: float = 0.0
    range_noise: float = 0.02
    quantum: float = 0.0
    infrared_range: float | None = None
    mount: tuple[float, float, float] = (0.0, 0.0, 0.0)
    half_beams: tuple[tuple[float, float], ...] = ()

    @property
    def beam(self) -> Floats:
        """(k, 2) rows of metres and radians, the half-beam narrowing from row to row; one row where it is constant."""
        return np.array(self.half_beams) if self.half_beams else np.array([[np.inf, self.half_beam]])

    def half_beam_at(self, metres: float) -> float:
        """The half-beam in radians at a range."""
        return float(np.interp(metres, *self.beam.T)) if self.half_beams else self.half_beam


@dataclass(frozen=True, eq=False)
class Scan:
    """One turn of the head.

    bearings: (n,) in the sensor's frame, radians, strictly increasing, spanning at most one turn.
    ranges: (n,) metres; `inf` where no echo came, `nan` where the reading is unusable.
    infrared: (n,) two-digit codes (LEDs fired, comparator; 30 and 40: nothing detected), or None.
    odometry: (3,) the robot's dead-reckoned pose x, y, heading. time: seconds.
    """

    bearings: Floats
    ranges: Floats
    sensor: Sensor
    odometry: Floats
    time: float
    infrared: NDArray[np.int16] | None = None

    def __post_init__(self) -> None:
        """Check the shapes once, at the door."""
        if self.bearings.shape != self.ranges.shape or self.bearings.ndim != 1:
            raise ScanError(f"{self.ranges.size} ranges, but {self.bearings.size} bearings")
        if self.infrared is not None and self.infrared.shape != self.ranges.shape:
            raise ScanError(f"{self.infrared.size} infrared codes, but {self.ranges.size} ranges")
        if self.odometry.shape != (3,):
            raise ScanError(f"odometry needs x, y and heading, but has shape {self.odometry.shape}")

    @cached_property
    def full_turn(self) -> bool:
        """Whether the scan closes on itself: the gap across the wrap-around is like the step between readings."""
        if self.bearings.size < 3:
            return False
        return bool(2 * np.pi - (self.bearings[-1] - self.bearings[0]) < 2.5 * self.usual_step)

    @cached_property
    def usual_step(self) -> float:
        """The median step between bearings, radians; there must be two of them."""
        steps = np.sort(np.diff(self.bearings))  # np.median takes ten times as long on so few
        return float(steps[(len(steps) - 1) // 2] + steps[len(steps) // 2]) / 2
