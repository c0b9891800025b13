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


class ViewError(Exception):
    """A view whose arrays do not fit together; the message carries the numbers."""


@dataclass(frozen=True, eq=False)
class WideBeam:
    """What a wide beam leaves open at each corner (m,) of a view's boundary, metres.

    sure: length of beam from the origin that surely met nothing; beyond it the boundary is a bound that one wall in
    between makes void: an arc in a door, a sonar's silence. aside: how far to each side the surface met may lie.
    """

    sure: Floats
    aside: Floats


@dataclass(frozen=True, eq=False)
class View:
    """The star-shaped free space of one scan, in the robot's frame.

    boundary: (m, 2) ring, counter-clockwise, not closed. edges: (m,) EdgeKind of the edge from corner i to i + 1.
    spread: (m,) standard deviation of each corner along its beam, metres.
    origin: (2,) where the sensor sat, in the robot's frame.
    openings: (d, 2, 2) pairs of door jambs the infrared found (right, left as seen).
    wide: what a wide beam leaves open; None for a beam as thin as the steps between its bearings.
    """

    boundary: Floats
    edges: NDArray[np.uint8]
    spread: Floats
    origin: Floats
    openings: Floats
    wide: WideBeam | None = None

    def __post_init__(self) -> None:
        """Check the shapes once, at the door."""
        corners = len(self.boundary)
        if self.boundary.shape != (corners, 2) or corners < 3:
            raise ViewError(f"a view needs a ring of three corners or more, but got shape {self.boundary.shape}")
        if self.edges.shape != (corners,) or self.spread.shape != (corners,):
            raise ViewError(f"{corners} corners, but {self.edges.size} edges and {self.spread.size} spreads")
        if self.wide is not None and not self.wide.sure.shape == self.wide.aside.shape == (corners,):
            raise ViewError(f"{corners} corners, but {self.wide.sure.size} sure lengths of a wide beam")

    def says_the_same(self, other: "View") -> bool:
        """Whether both views tell the same of the room."""
        mine, theirs = (
            (v.boundary, v.edges, v.spread, v.origin, v.openings, *((v.wide.sure, v.wide.aside) if v.wide else ()))
            for v in (self, other)
        )
        return len(mine) == len(theirs) and all(map(np.array_equal, mine, theirs))

    @property
    def free_space(self) -> Polygon:
        """The polygon inside the boundary."""
        return Polygon(self.boundary)

    @property
    def surely_free(self) -> Floats:
        """(m, 2) the ring of what the beams surely passed, corner by corner on the beams of the boundary."""
        if self.wide is None:
            return self.boundary
        beam = self.boundary - self.origin
        length = np.linalg.norm(beam, axis=1)
        share = np.where(self.wide.sure < length, self.wide.sure / np.maximum(length, 1e-9), 1.0)
        return np.where((share < 1)[:, None], self.origin + share[:, None] * beam, self.boundary)


def place(points: Floats, pose: Floats) -> Floats:
    """Points (n, 2) of the robot's frame, in the frame its pose (3,) is given in."""
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    turned: Floats = points @ np.array([[cosine, sine], [-sine, cosine]]) + pose[:2]
    return turned
