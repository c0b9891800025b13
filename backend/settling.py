"""Settling: views that see the same walls agree on where these are, each giving way within its pose's uncertainty.

Every pass fits cell lines to all views at once and then solves for all poses together, so the outcome does not depend
on the order of the views. The prior holds what the walls leave open, as along a corridor.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from backend.cell_lines import CellGrid, cell_lines
from backend.samples import Samples
from backend.shared_lines import joined, normal_equations, solved
from backend.wall_directions import DirectionSettings, alignment, angle_errors

Floats = NDArray[np.float64]
GOLDEN = 0.618034
RIGID = 1e12  # stiffness of a view that stays


@dataclass(frozen=True)
class SettleSettings:
    """Opinions of settling."""

    position_sigma: float = 0.05  # metres; larger lets views move farther from their poses
    heading_sigma: float = 0.01  # radians; larger lets views turn farther from their poses
    passes: int = 12  # more match surfaces anew more often on the way from the widest to the finest
    widest: float = 0.08  # metres; larger matches surfaces from farther apart in the first pass
    finest: float = 0.015  # metres; larger keeps more of the disagreement in the last pass
    coarse_cell: float = 0.6  # metres; larger joins more views to a line in the first pass
    fine_cell: float = 0.3  # metres; smaller follows bent walls better in the last pass
    independent: float = 0.10  # metres of surface that count as one measurement; larger trusts the prior more
    stale: float = 0.03  # of the views may change before all settle anew; larger looks faster, at poses settled less
    directions: DirectionSettings = field(default_factory=DirectionSettings)


def settle(local: Samples, poses: Floats, settings: SettleSettings) -> Floats:
    """Poses (v, 3) after settling; `local` are samples in the frames of their views, these rising rows of `poses`."""
    return _passes(local, poses, poses, np.ones(len(poses), dtype=np.bool_), settings)


def settle_among(
    local: Samples, given: Floats, settled: Floats, moving: NDArray[np.bool_], settings: SettleSettings
) -> Floats:
    """Poses (v, 3) where only the `moving` views (v,), put at `given`, settle: the others stay at `settled`.

    It costs what the moving views see, not the whole map.
    """
    start = np.where(moving[:, None], given, settled)
    placed = local.placed(start)
    near = placed.about(placed.points[moving[local.view]], settings.coarse_cell)
    return _passes(local.where(near), given, start, moving, settings)


def _passes(
    local: Samples, given: Floats, start: Floats, moving: NDArray[np.bool_], settings: SettleSettings
) -> Floats:
    settled = start.copy()
    for step in range(settings.passes):
        share = step / max(settings.passes - 1, 1)
        width = settings.widest * (settings.finest / settings.widest) ** share
        size = settings.coarse_cell * (settings.fine_cell / settings.coarse_cell) ** share
        shift = (step * GOLDEN) % 1.0
        grid = CellGrid(size, np.array([shift, (shift + 0.5) % 1.0]) * size, shift * np.pi / 6)
        found = _step(local, (settled, given, moving), (grid, width), settings)
        settled[moving] += found[moving]
    return settled


def _step(
    local: Samples,
    views: tuple[Floats, Floats, NDArray[np.bool_]],
    how: tuple[CellGrid, float],
    settings: SettleSettings,
) -> Floats:
    """The Gauss–Newton step (v, 3) of all views; of these, where they stand now, where they were put, and who moves."""
    (settled, given, moving), (grid, width) = views, how
    placed = local.placed(settled)
    scale = np.hypot(placed.sigma, width)
    lines = cell_lines(placed.points, placed.normals, placed.weight / scale**2, scale, grid)
    weight = lines.trust * placed.weight / (settings.independent * scale**2)
    blocks, gradient, shared = normal_equations(placed, weight, lines, settled)
    prior = 1 / np.array([settings.position_sigma, settings.position_sigma, settings.heading_sigma]) ** 2
    turns = np.asarray(np.linalg.inv(blocks + prior * np.eye(3))[:, 2, 2], dtype=np.float64)
    pull, torque, aligned = alignment(placed, angle_errors(local, settings.independent), turns, settings.directions)
    blocks[:, 2, 2] += pull
    gradient[:, 2] += torque
    stiffness = np.where(moving[:, None], prior, RIGID)
    right = np.where(moving[:, None], -gradient - prior * (settled - given), 0.0)
    return solved(blocks + stiffness[:, :, None] * np.eye(3), joined(shared, aligned), right)
