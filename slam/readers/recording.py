"""A recording: the scans of one drive in order, and what of the file could not be used."""

from dataclasses import dataclass

from frontend.scan import Scan
from slam.trajectory_file import Trajectory


class RecordingError(Exception):
    """A recording that cannot be read; the message names the file, the line and the numbers."""


@dataclass(frozen=True)
class DamagedLine:
    """A line or numbered message that was left out, or used only in part, and why; None where it is the whole file."""

    file: str
    line: int | None
    reason: str

    def __str__(self) -> str:
        place = "" if self.line is None else f" line {self.line}"
        return f"{self.file}{place}: {self.reason}"


@dataclass(frozen=True)
class OdometryNoise:
    """What the wheels add, a fact of the robot: standard deviations in m per m, rad per rad and rad per m."""

    distance_noise: float
    turn_noise: float
    turn_per_metre_noise: float


@dataclass(frozen=True, eq=False)
class Recording:
    """Scans in the order of their times, at least one.

    odometry_noise: None where nobody measured it. odometry: raw dead reckoning between the scans, where the file has
    more of it than the scans carry. starts: numbers of the scans after the first that begin another drive.
    """

    name: str
    scans: tuple[Scan, ...]
    damaged: tuple[DamagedLine, ...] = ()
    odometry_noise: OdometryNoise | None = None
    odometry: Trajectory | None = None
    starts: tuple[int, ...] = ()
