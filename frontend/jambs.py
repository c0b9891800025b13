"""Jambs: where a near surface ends in front of deeper space.

The design of the paper bars knots that touch a fake edge, because a shadow moves with the viewpoint. That holds for
the far side of a fake edge; its near side is where the occluding wall itself ends, which stays where it is. It is
known to about one beam along the wall, and its covariance says so.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frontend.compiled import compiled
from frontend.lines import fit_line
from frontend.scan import Floats, Integers


@dataclass(frozen=True)
class JambSettings:
    """Opinions of the jamb search; lengths in metres."""

    depth: float = 0.4  # the space behind must be deeper by this; larger keeps only clear ends
    support: float = 1.0  # wall used for the line; larger is surer on straight walls
    least_support: float = 0.2  # wall there must be; larger drops jambs of thin things
    least_points: int = 4  # readings there must be; larger drops far jambs
    roughness: float = 2.5  # rms across the line in units of the noise; larger takes rough or curved walls
    widest_step: float = 0.25  # gap to the next beam along the wall; larger keeps less certain jambs


@dataclass(frozen=True, eq=False)
class Jambs:
    """Jambs of a contour, columns as in the primal sketch; vertices: (j,) the last vertex of each surface."""

    positions: Floats
    covariances: Floats
    turns: Floats
    headings: Floats
    walls: Floats
    vertices: Integers


def find_jambs(
    points: Floats, noise: Floats, edges: NDArray[np.uint8], origin: Floats, settings: JambSettings
) -> Jambs:
    """Jambs among the contour's vertices (n, 2) with EdgeKind (n,) to the next."""
    limits = np.array([settings.depth, settings.support, settings.least_support,
                       settings.least_points, settings.roughness, settings.widest_step])  # fmt: skip
    rays = points - origin
    opens = _jambs_one_way(rays, noise, edges, limits)
    mirrored = _jambs_one_way(rays[::-1] * np.array([1.0, -1.0]), noise[::-1], np.roll(edges[::-1], -1), limits)
    mirrored[:, 0] = points.shape[0] - 1 - mirrored[:, 0]
    rows = np.vstack([opens, mirrored * np.array([1, 1, -1, 1, -1, 1, -1])])
    along = rows[:, 6] + np.where(np.arange(rows.shape[0]) < opens.shape[0], 0.0, np.pi)
    ends_before = np.arange(rows.shape[0]) < opens.shape[0]
    walls = np.where(np.column_stack([ends_before, ~ends_before]), along[:, None], np.nan)
    sight = np.arctan2(rows[:, 2], rows[:, 1]) + np.where(ends_before, 0.0, np.pi)
    turns = np.where(ends_before, sight - along, along - sight)
    turns = np.pi - np.mod(np.pi - turns, 2 * np.pi)
    first = np.where(ends_before, along, sight)
    return Jambs(
        positions=rows[:, 1:3] + origin,
        covariances=rows[:, [3, 4, 4, 5]].reshape(-1, 2, 2),
        turns=turns,
        headings=np.pi - np.mod(np.pi - (first + 0.5 * turns + 0.5 * np.pi), 2 * np.pi),
        walls=walls,
        vertices=rows[:, 0].astype(np.int64),
    )


@compiled
def _jambs_one_way(rays: Floats, noise: Floats, edges: NDArray[np.uint8], limits: Floats) -> Floats:
    """Jambs (j, 7) vertex, x, y, xx, xy, yy, wall direction, of surfaces whose counter-clockwise end is free."""
    depth, support, least_support, least_points, roughness, widest = limits
    n = rays.shape[0]
    rows = np.empty((n, 7))
    found = 0
    for i in range(n):
        j = (i + 1) % n
        deeper = np.hypot(rays[j, 0], rays[j, 1]) - np.hypot(rays[i, 0], rays[i, 1])
        if edges[i] not in (1, 4) or edges[i - 1] != 0 or deeper < depth:
            continue
        start = i
        while i - start < n - 1 and edges[(start - 1) % n] == 0:
            if np.hypot(rays[i, 0] - rays[(start - 1) % n, 0], rays[i, 1] - rays[(start - 1) % n, 1]) > support:
                break
            start -= 1
        count = i - start + 1
        wall = np.empty((count, 2))
        for k in range(count):
            wall[k] = rays[(start + k) % n]
        length = np.hypot(wall[-1, 0] - wall[0, 0], wall[-1, 1] - wall[0, 1])
        if count < least_points or length < least_support:
            continue
        line = fit_line(wall, 0, count, noise[i])
        cx, cy = np.cos(line[2]), np.sin(line[2])
        step = _step_along(rays[i], rays[j], line)
        if line[5] > roughness * noise[i] or not 0 < step < widest:
            continue
        reach = (rays[i, 0] - line[0]) * cx + (rays[i, 1] - line[1]) * cy + 0.5 * step
        across = line[3] + line[4] * reach**2
        along = step**2 / 12 + noise[i] ** 2
        rows[found] = np.array([
            float(i), line[0] + reach * cx, line[1] + reach * cy,
            along * cx * cx + across * cy * cy, (along - across) * cx * cy, along * cy * cy + across * cx * cx, line[2],
        ])  # fmt: skip
        found += 1
    return rows[:found]


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
