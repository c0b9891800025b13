"""Settling: views that see the same walls agree on where these are, each giving way within its pose's uncertainty.

Every pass fits cell lines to all views at once and then moves each view onto them, so the outcome does not depend
on the order of the views. The prior holds what the walls leave open, as along a corridor.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from backend.cell_lines import CellGrid, CellLines, cell_lines, distinct_views
from backend.samples import Samples

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
GOLDEN = 0.618034


@dataclass(frozen=True)
class SettleSettings:
    """Opinions of settling."""

    position_sigma: float = 0.05  # metres; larger lets views move farther from their poses
    heading_sigma: float = 0.01  # radians; larger lets views turn farther from their poses
    passes: int = 12  # more settle longer chains of views
    widest: float = 0.08  # metres; larger matches surfaces from farther apart in the first pass
    finest: float = 0.015  # metres; larger keeps more of the disagreement in the last pass
    coarse_cell: float = 0.6  # metres; larger joins more views to a line in the first pass
    fine_cell: float = 0.3  # metres; smaller follows bent walls better in the last pass
    independent: float = 0.10  # metres of surface that count as one measurement; larger trusts the prior more
    relaxation: float = 1.5  # larger converges faster, 2 and above never


def settle(local: Samples, poses: Floats, settings: SettleSettings) -> Floats:
    """Poses (v, 3) after settling; `local` are samples in the frames of their views, view (n,) a row of `poses`."""
    settled = poses.copy()
    prior = 1 / np.array([settings.position_sigma, settings.position_sigma, settings.heading_sigma]) ** 2
    for step in range(settings.passes):
        share = step / max(settings.passes - 1, 1)
        width = settings.widest * (settings.finest / settings.widest) ** share
        size = settings.coarse_cell * (settings.fine_cell / settings.coarse_cell) ** share
        shift = (step * GOLDEN) % 1.0
        grid = CellGrid(size, np.array([shift, (shift + 0.5) % 1.0]) * size, shift * np.pi / 6)
        settled += settings.relaxation * _step(local, settled, (poses, prior), (grid, width, settings.independent))
    return settled


def _step(local: Samples, settled: Floats, prior: tuple[Floats, Floats], how: tuple[CellGrid, float, float]) -> Floats:
    """One Gauss–Newton step (v, 3) of every view against the lines of all."""
    (poses, stiffness), (grid, width, independent) = prior, how
    placed = local.placed(settled)
    scale = np.hypot(placed.sigma, width)
    lines = cell_lines(placed.points, placed.normals, placed.weight / scale**2, scale, grid)
    weight = _weights(placed, lines) * placed.weight / (independent * scale**2)
    normals = lines.normals[lines.group]
    arm = placed.points - settled[placed.view, :2]
    turn = arm[:, 0] * normals[:, 1] - arm[:, 1] * normals[:, 0]
    jacobian = np.stack([normals[:, 0], normals[:, 1], turn], axis=1)
    hessian = np.tile(np.diag(stiffness), (len(poses), 1, 1))
    gradient = stiffness * (settled - poses)
    for i in range(3):
        gradient[:, i] += np.bincount(placed.view, weight * jacobian[:, i] * lines.residuals, len(poses))
        for j in range(3):
            hessian[:, i, j] += np.bincount(placed.view, weight * jacobian[:, i] * jacobian[:, j], len(poses))
    return np.asarray(-np.linalg.solve(hessian, gradient[:, :, None])[:, :, 0])


def _weights(placed: Samples, lines: CellLines) -> Floats:
    """Trust of each sample; none in lines that only one view has, or that face elsewhere than the sample."""
    shared = distinct_views(lines.group, placed.view, len(lines.keys)) >= 2
    facing = np.sum(placed.normals * lines.normals[lines.group], axis=1) > np.cos(np.radians(20))
    return np.asarray(lines.trust * shared[lines.group] * facing)
