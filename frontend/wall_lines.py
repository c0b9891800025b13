"""Walls beside a place of the profile: the straight wall that leads there from one side, read where it is read right.

In corners and beside gaps a wide beam reads short, so a wall is fitted where it was measured and continued from there.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from frontend.compiled import compiled
from frontend.lines import fit_line
from frontend.scan import Booleans, Floats

LEAST_READINGS = 5  # of a fit: four readings of an arc of constant range look straight
FARTHEST = np.radians(60.0)  # from the place: a wall that begins farther off says little there


@dataclass(frozen=True, eq=False)
class Profile:
    """A full or part turn: bearings and ranges (n,), and which of the readings (n,) are surface and no bound."""

    bearings: Floats
    ranges: Floats
    measured: Booleans

    @cached_property
    def points(self) -> Floats:
        """(n, 2) where the readings end, in the sensor's frame."""
        return np.asarray(self.ranges[:, None] * np.column_stack([np.cos(self.bearings), np.sin(self.bearings)]))

    @cached_property
    def step(self) -> float:
        """Radians from one bearing to the next."""
        return float(np.median(np.diff(self.bearings)))


@dataclass(frozen=True, eq=False)
class WallLine:
    """A fitted wall in the sensor's frame: middle (2,), direction, and variances of its offset and its direction.

    away: how many readings from the place the fit begins.
    """

    middle: Floats
    direction: float
    offset_variance: float
    direction_variance: float
    away: int

    def ranges(self, bearings: Floats) -> tuple[Floats, Floats]:
        """Where beams (n,) meet the wall, `inf` where they do not, and how surely: metres and standard deviations."""
        across = np.sin(bearings - self.direction)
        normal = np.array([-np.sin(self.direction), np.cos(self.direction)])
        offset = float(self.middle @ normal)
        meets = across * offset > 1e-9
        ranges = np.where(meets, offset / np.where(meets, across, 1.0), np.inf)
        along = ranges * np.cos(bearings - self.direction) - float(
            self.middle @ np.array([np.cos(self.direction), np.sin(self.direction)])
        )
        spread = np.sqrt(self.offset_variance + along**2 * self.direction_variance) / np.maximum(np.abs(across), 1e-9)
        return ranges, np.where(meets, spread, np.inf)


def wall_beside(profile: Profile, place: int, sense: int, noise: float) -> WallLine | None:
    """The wall that leads to reading `place` from the side of `sense` (1: counter-clockwise of it, −1), or None.

    noise: metres, of a reading.
    """
    span = min(int(FARTHEST / profile.step), profile.bearings.size // 2)
    row = _longest_line(profile.points, profile.measured, place, sense, span, noise)
    return None if np.isnan(row[0]) else WallLine(row[:2], float(row[2]), float(row[3]), float(row[4]), int(row[5]))


@compiled
def _longest_line(points: Floats, measured: Booleans, place: int, sense: int, span: int, noise: float) -> Floats:
    """The fit over the most readings of one unbroken stretch, none over 4 standard deviations off; its start last."""
    n = points.shape[0]
    best, most = np.full(6, np.nan), LEAST_READINGS - 1
    for start in range(span):
        stretch = np.empty((span - start, 2))
        count = 0
        while count < span - start and measured[(place + sense * (start + count)) % n]:
            stretch[count] = points[(place + sense * (start + count)) % n]
            count += 1
            if count > most:
                line = fit_line(stretch, 0, count, noise)
                x, y = np.cos(line[2]), np.sin(line[2])
                across = (stretch[:count, 1] - line[1]) * x - (stretch[:count, 0] - line[0]) * y
                if np.max(np.abs(across)) <= 4 * noise:
                    best, most = line, count
                    best[5] = start
    return best
