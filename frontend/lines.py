"""Fitted lines: total least squares with the variances that knots and registration need."""

from dataclasses import dataclass

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines fitted between knots, in the robot's frame.

    ends: (l, 2, 2) in the contour's order, free space on the left. normals: (l, 2) towards the free space.
    offset_spread, angle_spread: (l,) standard deviations of the offset at the middle (m) and the direction (rad).
    readings: (l, 2) first and last reading.
    """

    ends: Floats
    normals: Floats
    offset_spread: Floats
    angle_spread: Floats
    readings: Integers


@compiled
def fit_line(points: Floats, start: int, stop: int, noise: float) -> Floats:
    """Line through points[start:stop] (n, 2): x, y of the middle, angle, variances of offset and angle, rms across.

    The variances use the larger of the noise and the scatter seen: a line can look better than its sensor by luck.
    """
    count = stop - start
    x, y = np.mean(points[start:stop, 0]), np.mean(points[start:stop, 1])
    xx, xy, yy = 0.0, 0.0, 0.0
    for i in range(start, stop):
        dx, dy = points[i, 0] - x, points[i, 1] - y
        xx += dx * dx
        xy += dx * dy
        yy += dy * dy
    root = np.sqrt((0.5 * (xx - yy)) ** 2 + xy * xy)
    along, across = 0.5 * (xx + yy) + root, max(0.5 * (xx + yy) - root, 0.0)
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    forward = (points[stop - 1, 0] - points[start, 0]) * np.cos(angle) + (
        points[stop - 1, 1] - points[start, 1]
    ) * np.sin(angle)
    if forward < 0:
        angle += np.pi
    variance = max(noise**2, across / max(count - 2, 1))
    return np.array([x, y, angle, variance / count, variance / max(along, 1e-12), np.sqrt(across / count)])


@compiled
def crossing(first: Floats, second: Floats) -> Floats:
    """Where two fitted lines meet, and how surely: x, y, variances xx, xy, yy; nan where they are parallel."""
    n1x, n1y = -np.sin(first[2]), np.cos(first[2])
    n2x, n2y = -np.sin(second[2]), np.cos(second[2])
    det = n1x * n2y - n1y * n2x
    if abs(det) < 1e-6:
        return np.full(5, np.nan)
    d1, d2 = n1x * first[0] + n1y * first[1], n2x * second[0] + n2y * second[1]
    x, y = (n2y * d1 - n1y * d2) / det, (n1x * d2 - n2x * d1) / det
    v1 = first[3] + first[4] * ((x - first[0]) ** 2 + (y - first[1]) ** 2)
    v2 = second[3] + second[4] * ((x - second[0]) ** 2 + (y - second[1]) ** 2)
    a, b, c, d = n2y / det, -n1y / det, -n2x / det, n1x / det
    return np.array([x, y, a * a * v1 + b * b * v2, a * c * v1 + b * d * v2, c * c * v1 + d * d * v2])


def wall_lines(points: Floats, readings: Floats, real: Booleans, noise: Floats) -> Lines:
    """Lines through the vertices (n, 2) between each knot and the next where that edge is surface.

    readings: (k,) places of the knots among the vertices; real: (k,) whether the edge to the next knot is surface.
    Edges of fewer than three vertices are left out.
    """
    n = points.shape[0]
    start = np.ceil(readings).astype(np.int64)
    stop = np.floor(np.roll(readings, -1)).astype(np.int64)
    stop = np.where(np.roll(readings, -1) <= readings, stop + n, stop)
    chosen = np.flatnonzero(real & (stop - start >= 2))
    twice = np.vstack([points, points])
    fits = _fit_lines(twice, start[chosen], stop[chosen] + 1, noise)
    middle, along = fits[:, :2], np.column_stack([np.cos(fits[:, 2]), np.sin(fits[:, 2])])
    ends = np.stack([twice[start[chosen]], twice[stop[chosen]]], axis=1)
    feet = np.sum((ends - middle[:, None]) * along[:, None], axis=2)
    return Lines(
        ends=middle[:, None] + feet[:, :, None] * along[:, None],
        normals=np.column_stack([-along[:, 1], along[:, 0]]),
        offset_spread=np.sqrt(fits[:, 3]),
        angle_spread=np.sqrt(fits[:, 4]),
        readings=np.column_stack([start[chosen] % n, stop[chosen] % n]),
    )


@compiled
def _fit_lines(points: Floats, starts: Integers, stops: Integers, noise: Floats) -> Floats:
    """The fitted line (l, 6) through each stretch of the points."""
    fits = np.empty((starts.size, 6))
    for k in range(starts.size):
        fits[k] = fit_line(points, starts[k], stops[k], noise[starts[k] % noise.size])
    return fits
