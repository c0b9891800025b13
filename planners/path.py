"""A path, or the reason why there is none."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Kind = Literal["path", "not found", "no path", "undecided"]


class PlanningError(Exception):
    """A start or goal where the robot cannot stand; the message says which and by how much."""


@dataclass(frozen=True, eq=False)
class Path:
    """A continuous motion: x, y and heading change linearly between successive poses.

    poses: (p, 3), headings unwrapped. clearance: lower bound, over the whole motion, of the distance to the nearest
    obstacle, metres. certificate: how the motion was proved free.
    """

    poses: Floats
    clearance: float
    certificate: str

    @property
    def length(self) -> float:
        """How far the reference point travels, metres."""
        return float(np.linalg.norm(np.diff(self.poses[:, :2], axis=0), axis=1).sum())

    @property
    def turning(self) -> float:
        """How much the robot turns in all, radians."""
        return float(np.abs(np.diff(self.poses[:, 2])).sum())


@dataclass(frozen=True, eq=False)
class Cone:
    """A generalized cone: spine (2, 2) from end to end, cut into n slices. legal (n, k, 2): the headings each slice
    keeps, as increasing intervals in [0, 2π], padded with nan. drawing: makes its outline, looked at or not."""

    spine: Floats
    legal: Floats
    drawing: Callable[[], Floats]

    @cached_property
    def outline(self) -> Floats:
        """Corners (4n, 2) of the free strip: begin and end of every slice on one side, then back on the other."""
        return self.drawing()


@dataclass(frozen=True, eq=False)
class Cells:
    """Boxes of configuration space: lows and highs (n, 3) in x, y, heading; labels (n,) as in `planners.cells`."""

    lows: Floats
    highs: Floats
    labels: NDArray[np.int8]


@dataclass(frozen=True, eq=False)
class Gap:
    """What stands in the way: two edges (2, 2, 2) of the world, their distance and the passage the robot needs.

    place: (2,) the narrowest on the widest way.
    """

    edges: Floats
    width: float
    needed: float
    place: Floats


@dataclass(frozen=True, eq=False)
class Answer:
    """What a planner says.

    kind: "path"; "not found" (searched, no promise); "no path" (proved); "undecided" (at the stated resolution).
    reason: one sentence. cones, cells: what the planner built, for drawing. gap: the witness of "no path".
    """

    kind: Kind
    reason: str
    path: Path | None = None
    cones: tuple[Cone, ...] = field(default=(), repr=False)
    cells: Cells | None = field(default=None, repr=False)
    gap: Gap | None = None
