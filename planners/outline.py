"""A robot's outline as plain arrays for the compiled loops."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.robot import Robot

Floats = NDArray[np.float64]


class Outline(NamedTuple):
    """Corners (v, 2), and sides (v, 3) as outward unit normal and offset; part k has rows first[k] to first[k + 1].

    radius: metres by which the parts are rounded; the sides do not count it.
    """

    corners: Floats
    sides: Floats
    first: NDArray[np.int64]
    radius: float


def outline_of(robot: Robot) -> Outline:
    """The arrays of `robot`; the one corner of a disc gets a side without direction."""
    first = np.cumsum([0, *(len(part) for part in robot.parts)], dtype=np.int64)
    sides = np.concatenate([_sides(part) for part in robot.parts])
    return Outline(np.ascontiguousarray(robot.corners, dtype=float), sides, first, float(robot.radius))


def _sides(part: Floats) -> Floats:
    along = np.roll(part, -1, axis=0) - part
    lengths = np.maximum(np.linalg.norm(along, axis=1, keepdims=True), np.finfo(float).tiny)
    normals = np.stack([along[:, 1], -along[:, 0]], axis=1) / lengths
    return np.column_stack([normals, np.einsum("ij,ij->i", normals, part)])
