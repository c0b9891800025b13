"""Surface points for registration: line fits over neighbouring beams of one real chain, facing the sensor."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True, eq=False)
class Surface:
    """Measured surface in the robot's frame: points (k, 2) on the line fits through the readings around them, unit
    normals (k, 2) towards the sensor.

    spread: (k,) standard deviation across the surface, metres. reading: (k,) index into the scan.
    """

    points: Floats
    normals: Floats
    spread: Floats
    reading: Integers

    @cached_property
    def usual_spread(self) -> float:
        """The median of the spread, metres; 0 without surface."""
        if len(self.spread) == 0:
            return 0.0
        spread = np.sort(self.spread)  # np.median takes ten times as long on so few
        return float(spread[(len(spread) - 1) // 2] + spread[len(spread) // 2]) / 2


def fit_reaches(step: float, ranges: Floats, spread: Floats, surest: float, least: int, widest: float) -> Integers:
    """How many neighbours (n,) to each side, `step` radians apart, a line fit needs to know its direction to `surest`.

    The direction of n readings over a length L has the standard deviation σ√12 / (L√n); fine beams on near walls need
    many of them. Never under `least` neighbours nor over `widest` metres to a side.
    """
    steps = np.maximum(ranges * step, 1e-6)
    needed = (np.sqrt(12) * spread / (surest * 2 * np.sqrt(2) * steps)) ** (2 / 3)
    reaches: Integers = np.maximum(np.ceil(np.minimum(needed, widest / steps)), least).astype(np.int64)
    return reaches


@compiled
def line_fits(points: Floats, joined: Booleans, reaches: Integers, origin: Floats) -> tuple[Floats, Floats, Floats]:
    """Normals (n, 2), thickness (n,) and offset (n,) of the best line through each of the points (n, 2) and its
    chain neighbours; the offset is how far before the point, along the normal, the line runs.

    joined: (n,) whether a point and the next (cyclically) lie on one surface. reaches: (n,) neighbours to each side.
    Of the windows around, before and behind a point the thinnest wins, so a corner keeps the normals of both its
    walls. nan under three points.
    """
    n = points.shape[0]
    normals = np.full((n, 2), np.nan)
    thickness = np.full(n, np.nan)
    offset = np.full(n, np.nan)
    for i in range(n):
        before, after, reach = 0, 0, reaches[i]
        while before < reach and joined[(i - before - 1) % n]:
            before += 1
        while after < reach and joined[(i + after) % n]:
            after += 1
        best = np.inf
        for first, last in ((-before, after), (-before, 0), (0, after)):
            whole = first == -before and last == after
            if last - first < 2 or (not whole and last - first < reach):
                continue
            angle, variance, mx, my = _line_through(points, i + first, last - first + 1)
            # The window around the point has the firmest direction: a side must be clearly thinner to win.
            score = variance if whole else 2 * variance
            if score < best:
                best = score
                x, y = -np.sin(angle), np.cos(angle)
                facing = x * (origin[0] - points[i, 0]) + y * (origin[1] - points[i, 1])
                normals[i, 0], normals[i, 1] = (x, y) if facing > 0 else (-x, -y)
                thickness[i] = np.sqrt(variance)
                offset[i] = normals[i, 0] * (mx - points[i, 0]) + normals[i, 1] * (my - points[i, 1])
    return normals, thickness, offset


@compiled
def _line_through(points: Floats, start: int, count: int) -> tuple[float, float, float, float]:
    """Direction of the total least squares line through `count` cyclic points, the variance across it, its middle."""
    n = points.shape[0]
    x, y = 0.0, 0.0
    for k in range(start, start + count):
        x += points[k % n, 0] / count
        y += points[k % n, 1] / count
    xx, xy, yy = 0.0, 0.0, 0.0
    for k in range(start, start + count):
        dx, dy = points[k % n, 0] - x, points[k % n, 1] - y
        xx += dx * dx
        xy += dx * dy
        yy += dy * dy
    across = 0.5 * (xx + yy) - np.sqrt((0.5 * (xx - yy)) ** 2 + xy * xy)
    return 0.5 * np.arctan2(2 * xy, xx - yy), max(across, 0.0) / (count - 2), x, y
