"""A view: what one scan says of the room, ready to be placed and merged with the others."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

Floats = NDArray[np.float64]


class EdgeKind(IntEnum):
    """Why a view's boundary has an edge (Flynn 1988, §4.1: filler marks fake edges)."""

    REAL = 0  # surface that was measured
    OCCLUSION = 1  # line of sight between two depths: filler points
    NO_RETURN = 2  # nothing answered: the real distance is greater
    SIDE = 3  # the limit of the field of view
    DOOR_ARC = 4  # redrawn between two infrared edges: a lower bound, not a surface


@dataclass(frozen=True, eq=False)
class View:
    """The star-shaped free space of one scan, in the robot's frame.

    boundary: (m, 2) ring, counter-clockwise, not closed. edges: (m,) EdgeKind of the edge from corner i to i + 1.
    spread: (m,) standard deviation of each corner along its beam, metres.
    origin: (2,) where the sensor sat, in the robot's frame.
    openings: (d, 2, 2) pairs of door jambs the infrared found (right, left as seen).
    """

    boundary: Floats
    edges: NDArray[np.uint8]
    spread: Floats
    origin: Floats
    openings: Floats

    @property
    def free_space(self) -> Polygon:
        """The polygon inside the boundary."""
        return Polygon(self.boundary)
