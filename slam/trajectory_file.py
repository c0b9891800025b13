"""Trajectories in text: TUM lines (time x y z qx qy qz qw) in and out, and a camera's P lines (P ms x y) in."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from frontend.scan import Floats


class TrajectoryFileError(Exception):
    """A trajectory that cannot be read; the message names the file, the line and the numbers."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """times (n,) seconds, strictly increasing; positions (n, 2); headings (n,) radians, or None where not recorded."""

    times: Floats
    positions: Floats
    headings: Floats | None

    @property
    def poses(self) -> Floats:
        """(n, 3); TrajectoryFileError where only positions are known."""
        if self.headings is None:
            raise TrajectoryFileError(f"{self.times.size} positions come without headings, but poses are needed")
        return np.column_stack([self.positions, self.headings])


def tum_text(times: Floats, poses: Floats) -> str:
    """Poses (n, 3) at times (n,) as TUM lines; microseconds and micrometres are kept, the sign of a zero is not."""
    lines = [
        f"{time:.6f} {x:z.6f} {y:z.6f} 0 0 0 {np.sin(heading / 2):z.9f} {np.cos(heading / 2):z.9f}\n"
        for time, (x, y, heading) in zip(times, poses, strict=True)
    ]
    return "".join(lines)


def read_trajectory(path: Path) -> Trajectory:
    """The trajectory at `path`, of whichever kind its first line is."""
    try:
        lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as reason:
        raise TrajectoryFileError(f"{path} cannot be read: {reason.strerror or reason}") from reason
    numbered = [(i, line.split()) for i, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    if not numbered:
        raise TrajectoryFileError(f"{path}: no pose in it")
    positions_only = numbered[0][1][0] == "P"
    rows = np.array([_row(f"{path.name} line {i}", fields, positions_only) for i, fields in numbered])
    backward = np.diff(rows[:, 0]) <= 0
    if backward.any():
        line = numbered[int(np.argmax(backward)) + 1][0]
        raise TrajectoryFileError(f"{path.name} line {line}: its time does not come after the one before")
    if positions_only:
        return Trajectory(rows[:, 0] / 1000, rows[:, 1:] / 1000, None)
    return Trajectory(rows[:, 0], rows[:, 1:3], 2 * np.arctan2(rows[:, 6], rows[:, 7]))


def _row(place: str, fields: list[str], positions_only: bool) -> list[float]:
    wanted = 4 if positions_only else 8
    if len(fields) != wanted or (fields[0] == "P") is not positions_only:
        kind = "P ms x y" if positions_only else "time x y z qx qy qz qw"
        raise TrajectoryFileError(f"{place}: {len(fields)} fields, but {kind!r} has {wanted}")
    try:
        row = [float(field) for field in fields[positions_only:]]
    except ValueError as reason:
        raise TrajectoryFileError(f"{place}: {reason}") from reason
    if not np.isfinite(row).all():
        raise TrajectoryFileError(f"{place}: a number is not finite")
    return row
