"""Long faces: a cell takes the direction of the piece of wall around it, unless it clearly has one of its own.

Every cell's own direction is a little wrong. Where all walls are parallel, errors are all that tells places along them
apart: a scan would be drawn along a smooth corridor to where its noise fits best, and away from what the wheels say.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from backend.face_cells import Lines, in_squares

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Straightness:
    """stretch: cells to a side of a piece of wall. sectors: facing sides that the cells tell apart.

    thickest: metres rms of a straight piece, or twice that of its cells. sigmas: of a cell's own direction within which
    it takes the piece's. shared: points whose errors are one.
    """

    stretch: int
    sectors: int
    thickest: float
    sigmas: float
    shared: int


def straightened(lines: Lines, squares: Integers, rules: Straightness) -> Lines:
    """The lines with the directions of the pieces of wall that they are part of; squares (c, 3) of their cells."""
    chosen = np.flatnonzero(lines.kept)
    if len(chosen) == 0:
        return lines
    larger = squares[chosen].copy()
    larger[:, :2] //= rules.stretch
    pieces, known = in_squares(larger, rules.sectors)
    directions, straight = _pieces(lines, chosen, pieces, (len(known), rules.thickest))
    own, normals = lines.normals[chosen], directions[pieces]
    normals = normals * np.where(np.sum(own * normals, axis=1) < 0, -1.0, 1.0)[:, None]
    turned = own[:, 0] * normals[:, 1] - own[:, 1] * normals[:, 0]
    doubt = rules.shared * lines.across[chosen] / (lines.weight[chosen] * lines.along[chosen])
    taken = straight[pieces] & (turned**2 < rules.sigmas**2 * doubt)
    new = lines.normals.copy()
    new[chosen[taken]] = normals[taken]
    return replace(lines, normals=new)


def _pieces(
    lines: Lines, chosen: Integers, pieces: Integers, limits: tuple[int, float]
) -> tuple[Floats, NDArray[np.bool_]]:
    """Normals (p, 2) of the total least squares lines through all points of each piece, and whether it is straight.

    limits: how many pieces there are, and metres rms of a straight one.
    """
    count, thickest = limits
    weight, normals = lines.weight[chosen], lines.normals[chosen]
    total = np.bincount(pieces, weight, count)
    centres = np.column_stack([np.bincount(pieces, weight * lines.centres[chosen, k], count) / total for k in range(2)])
    off, along = lines.centres[chosen] - centres[pieces], np.column_stack([normals[:, 1], -normals[:, 0]])

    def moment(i: int, j: int) -> Floats:
        own = lines.across[chosen] * normals[:, i] * normals[:, j] + lines.along[chosen] * along[:, i] * along[:, j]
        return np.asarray(np.bincount(pieces, weight * (own + off[:, i] * off[:, j]), count) / total)

    xx, xy, yy = moment(0, 0), moment(0, 1), moment(1, 1)
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    across = 0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy)
    usual = np.bincount(pieces, weight * lines.across[chosen], count) / total
    straight = (across < np.maximum(thickest**2, 4 * usual)) & (xx + yy > 5 * across)
    return np.column_stack([-np.sin(angle), np.cos(angle)]), straight
