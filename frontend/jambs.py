"""Jambs and bumps: where a near surface ends in front of deeper space, on one side or on both.

The far side of a fake edge is a shadow and moves with the viewpoint: never a landmark. Its near side is where the
occluding thing itself ends, which stays where it is: a jamb, known to about one beam along the wall; a thing so narrow
that both its ends show is a bump, known to about its width. Their covariances say so.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frontend.compiled import compiled
from frontend.lines import fit_line
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True)
class JambSettings:
    """Opinions of the search for jambs and bumps; lengths in metres."""

    depth: float = 0.3  # the space behind must be deeper by this; larger keeps only clear ends
    support: float = 1.0  # wall used for the line; larger is surer on straight walls
    least_support: float = 0.15  # wall there must be for a direction; larger trusts fewer directions
    least_points: float = 4  # readings there must be for a direction; larger trusts fewer directions
    roughness: float = 4.0  # rms across the line in units of the noise; larger takes rough or curved walls
    widest_step: float = 0.3  # gap to the next beam along the wall; larger keeps less certain jambs
    widest_bump: float = 0.25  # width of a bump; larger takes furniture for one knot
    least_bump: float = 2  # readings on a bump; larger drops thin things and stray readings


@dataclass(frozen=True, eq=False)
class Jambs:
    """Jambs and bumps of a contour, columns as in the primal sketch; vertices: (j,) the vertex each lies on."""

    bumps: Booleans
    positions: Floats
    covariances: Floats
    turns: Floats
    headings: Floats
    walls: Floats
    vertices: Integers


def find_jambs(
    points: Floats, noise: Floats, edges: NDArray[np.uint8], origin: Floats, settings: JambSettings
) -> Jambs:
    """Jambs and bumps among the contour's vertices (n, 2) with EdgeKind (n,) to the next."""
    limits = np.array(
        [
            settings.depth,
            settings.support,
            settings.least_support,
            settings.least_points,
            settings.roughness,
            settings.widest_step,
            settings.widest_bump,
            settings.least_bump,
        ]
    )
    rows = near_ends(points - origin, noise, edges, limits)
    side, along = rows[:, 1], rows[:, 7]
    sight = np.arctan2(rows[:, 3], rows[:, 2])
    walls = np.where(np.column_stack([side == 1, side == -1]), along[:, None], np.nan)
    # Travelling counter-clockwise: along the wall and then away from the sensor, or back to the sensor and then along.
    known = np.where(np.isnan(along), sight + 0.5 * np.pi, along)
    turns = np.where(side == 1, sight - known, known - sight - np.pi)
    turns = np.where(side == 0, -np.pi, np.pi - np.mod(np.pi - turns, 2 * np.pi))
    headings = np.where(side == 1, known, sight + np.pi) + 0.5 * turns + 0.5 * np.pi
    headings = np.where(side == 0, sight + np.pi, headings)
    return Jambs(
        bumps=side == 0,
        positions=rows[:, 2:4] + origin,
        covariances=rows[:, [4, 5, 5, 6]].reshape(-1, 2, 2),
        turns=turns,
        headings=np.pi - np.mod(np.pi - headings, 2 * np.pi),
        walls=walls,
        vertices=rows[:, 0].astype(np.int64),
    )


@compiled
def near_ends(rays: Floats, noise: Floats, edges: NDArray[np.uint8], limits: Floats) -> Floats:
    """Ends of near surfaces (j, 8): vertex, side, x, y, xx, xy, yy, direction of the wall.

    side: 1 where the surface ends counter-clockwise, −1 clockwise, 0 for a bump. Direction nan where it is unsure.
    """
    depth, widest_bump, least_bump = limits[0], limits[6], limits[7]
    n = rays.shape[0]
    rows = np.empty((2 * n, 8))
    found = 0
    lengths = np.sqrt(rays[:, 0] ** 2 + rays[:, 1] ** 2)
    first = 0
    while first < n and edges[first - 1] == 0:
        first += 1
    start = first
    while start < first + n:
        stop = start
        while edges[stop % n] == 0 and stop < first + n:
            stop += 1
        i, j = start % n, stop % n
        before, after = edges[i - 1], edges[j]
        clockwise = before in (1, 4) and lengths[i - 1] - lengths[i] > depth
        counter = after in (1, 4) and lengths[(j + 1) % n] - lengths[j] > depth
        width = np.hypot(rays[i, 0] - rays[j, 0], rays[i, 1] - rays[j, 1])
        if clockwise and counter and width < widest_bump:
            if stop - start + 1 >= least_bump:
                rows[found] = _bump(rays, start, stop, noise[i])
                found += 1
        else:
            if clockwise:
                found += _jamb(rays, start, stop, -1, noise[i], limits, rows[found])
            if counter:
                found += _jamb(rays, start, stop, 1, noise[j], limits, rows[found])
        start = stop + 1
    return rows[:found]


@compiled
def _bump(rays: Floats, start: int, stop: int, noise: float) -> Floats:
    """The row of a bump: the middle of its face, unsure by its width along and a quarter of it in depth."""
    n = rays.shape[0]
    x, y = 0.0, 0.0
    count = stop - start + 1
    for k in range(start, stop + 1):
        x += rays[k % n, 0] / count
        y += rays[k % n, 1] / count
    reach = np.hypot(x, y)
    step = np.hypot(rays[start % n, 0] - rays[stop % n, 0], rays[start % n, 1] - rays[stop % n, 1]) / max(count - 1, 1)
    width = step * count
    cx, cy = x / reach, y / reach
    deep = noise**2 / count + (width / 4) ** 2
    wide = width**2 / 12
    middle = float(((start + stop) // 2) % n)
    return np.array([middle, 0.0, x, y, deep * cx * cx + wide * cy * cy, (deep - wide) * cx * cy,
                     deep * cy * cy + wide * cx * cx, np.nan])  # fmt: skip


@compiled
def _jamb(rays: Floats, start: int, stop: int, side: int, noise: float, limits: Floats, row: Floats) -> int:
    """Writes the row of the jamb at one end of a surface; 1 if there is one, 0 if it is too unsure."""
    support, least_support, least_points, roughness, widest = limits[1], limits[2], limits[3], limits[4], limits[5]
    n = rays.shape[0]
    end = (stop if side == 1 else start) % n
    wall = np.empty((stop - start + 1, 2))
    count = 0
    for k in range(stop - start + 1):
        i = (end - side * k) % n
        if np.hypot(rays[end, 0] - rays[i, 0], rays[end, 1] - rays[i, 1]) > support:
            break
        wall[count] = rays[i]
        count += 1
    if count < 2:
        return 0
    length = np.hypot(wall[count - 1, 0] - wall[0, 0], wall[count - 1, 1] - wall[0, 1])
    line = fit_line(wall[:count][::-1], 0, count, noise)  # its direction runs to the jamb
    firm = count >= least_points and length >= least_support and line[5] <= roughness * noise
    if not firm:
        line = fit_line(wall[:2][::-1], 0, 2, noise)
    step = _step_along(wall[0], rays[(end + side) % n], line)
    if not 0 < step < widest:
        if firm:
            return 0
        step = np.hypot(wall[0, 0] - wall[1, 0], wall[0, 1] - wall[1, 1])
        if step > widest:
            return 0
    cx, cy = np.cos(line[2]), np.sin(line[2])
    reach = (wall[0, 0] - line[0]) * cx + (wall[0, 1] - line[1]) * cy + 0.5 * step
    along = step**2 / 12 + noise**2
    across = line[3] + line[4] * reach**2 if firm else along
    row[0], row[1], row[2], row[3] = float(end), float(side), line[0] + reach * cx, line[1] + reach * cy
    row[4], row[5] = along * cx * cx + across * cy * cy, (along - across) * cx * cy
    row[6] = along * cy * cy + across * cx * cx
    row[7] = np.nan
    if firm:
        row[7] = line[2] if side == 1 else line[2] + np.pi
    return 1


@compiled
def _step_along(last: Floats, beyond: Floats, line: Floats) -> float:
    """How far along the wall the next beam would have met it."""
    cx, cy = np.cos(line[2]), np.sin(line[2])
    across = beyond[0] * cy - beyond[1] * cx
    if abs(across) < 1e-9:
        return np.inf
    reach = (line[0] * cy - line[1] * cx) / across
    if reach <= 0:
        return np.inf
    return float((reach * beyond[0] - last[0]) * cx + (reach * beyond[1] - last[1]) * cy)
