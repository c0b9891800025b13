"""A local map: earlier surface around a viewpoint, sorted into cells so that a scan finds its faces at once."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from frontend.point_to_line import faces_towards, in_order, lying_on, sort_into_cells
from frontend.rigid_motion import rotation, transform
from frontend.scan import Booleans, Floats, Integers
from frontend.surface import Surface

CELL = 0.25  # metres; about the distance at which registration looks for partners


@dataclass(frozen=True, eq=False)
class Faces:
    """Placed surface: points (k, 2) and unit normals (k, 2) towards whoever saw them, in the room's frame."""

    points: Floats
    normals: Floats

    @classmethod
    def placed(cls, surface: Surface, pose: Floats) -> Self:
        """The surface of a scan at its pose (3,)."""
        return cls(transform(surface.points, pose), surface.normals @ rotation(pose[2]).T)

    @classmethod
    def together(cls, parts: list["Faces"]) -> Self:
        """Several as one."""
        return cls(np.concatenate([part.points for part in parts]), np.concatenate([part.normals for part in parts]))

    def moved(self, pose: Floats) -> "Faces":
        """The same faces in the frame that `pose` (3,) is given in."""
        return Faces(transform(self.points, pose), self.normals @ rotation(pose[2]).T)

    def facing(self, viewpoint: Floats, reach: float) -> "Faces":
        """What of it turns its face to `viewpoint` (2,) within `reach` metres: facing side is identity."""
        return Faces(*faces_towards(self.points, self.normals, viewpoint, reach))


@dataclass(frozen=True, eq=False)
class LocalMap:
    """Faces in the order of their cells; first: (c + 1,) start of each cell; corner (2,), columns, rows of the grid."""

    faces: Faces
    first: Integers
    corner: Floats
    columns: int
    rows: int

    @classmethod
    def of(cls, faces: Faces) -> Self:
        """Prepare faces, at least one."""
        order, first, corner, columns, rows = sort_into_cells(faces.points, CELL)
        return cls(Faces(*in_order(faces.points, faces.normals, order)), first, corner, columns, rows)

    def lying(self, placed: Faces, near: float, across: float) -> tuple[Booleans, Booleans]:
        """(n,) which placed faces have faces of the map within `near` metres, and which lie on the line of the
        most alike of these, by place and facing side, but for `across` metres.

        How far along the wall the nearest is does not count: far along a wall, faces lie farther apart than partners do
        in registration, where only a scan from the very same place would find them.
        """
        faces, limits = self.faces, np.array([CELL, near, across])
        return lying_on(
            placed.points, placed.normals, faces.points, faces.normals,
            self.first, self.corner, self.columns, self.rows, limits,
        )  # fmt: skip
