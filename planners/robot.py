"""A robot's outline about its reference point: a disc, or a union of convex polygons."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPoint, Polygon

Floats = NDArray[np.float64]

CHORDS = 4  # per right angle, around the corners of a polygon that is grown
SYMMETRIES = (12, 10, 9, 8, 7, 6, 5, 4, 3, 2)


class RobotError(Exception):
    """An outline that makes no robot."""


@dataclass(frozen=True, eq=False)
class Robot:
    """All points within `radius` of the `parts`.

    parts: convex polygons (k, 2) in the robot's frame, counter-clockwise, metres. A disc is its centre, a part of one
    corner, with a radius; polygons have radius 0.
    """

    parts: tuple[Floats, ...]
    radius: float = 0.0

    @classmethod
    def disc(cls, radius: float) -> "Robot":
        """A disc about the reference point."""
        if not radius > 0:
            raise RobotError(f"a disc needs a radius above 0, but has {radius:g}")
        return cls((np.zeros((1, 2)),), float(radius))

    @classmethod
    def rectangle(cls, length: float, width: float) -> "Robot":
        """A rectangle centred on the reference point, `length` along x."""
        if not (length > 0 and width > 0):
            raise RobotError(f"a rectangle needs two sides above 0, but has {length:g} x {width:g}")
        return cls((np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * [length / 2, width / 2],))

    @classmethod
    def polygons(cls, *outlines: Floats) -> "Robot":
        """The union of `outlines` (k, 2); an outline that is not convex is cut into triangles."""
        parts = [part for outline in outlines for part in _convex_parts(np.asarray(outline, dtype=float))]
        if not parts:
            raise RobotError("a robot needs at least one outline")
        return cls(tuple(parts))

    @property
    def is_disc(self) -> bool:
        """Whether heading makes no difference."""
        return len(self.parts) == 1 and not self.parts[0].any()

    @property
    def corners(self) -> Floats:
        """(k, 2) corners of all parts."""
        return np.concatenate(self.parts)

    @cached_property
    def reach(self) -> float:
        """Distance of the farthest point from the reference point."""
        return float(np.linalg.norm(self.corners, axis=1).max()) + self.radius

    @cached_property
    def inner(self) -> float:
        """Radius of the largest disc about the reference point within one of the parts; 0 if the point is in none."""
        here = shapely.Point(0, 0)
        hulls = [MultiPoint(part).convex_hull for part in self.parts]
        inside = [isinstance(hull, Polygon) and hull.covers(here) for hull in hulls]
        depths = [
            hull.boundary.distance(here) if within else -hull.distance(here)
            for hull, within in zip(hulls, inside, strict=True)
        ]
        return max(0.0, self.radius + max(depths))

    @cached_property
    def width(self) -> float:
        """The narrowest straight passage that the outline fits through."""
        if self.is_disc:
            return 2 * self.radius
        hull = shapely.get_coordinates(MultiPoint(self.corners).convex_hull)
        along = np.diff(hull, axis=0)
        normals = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
        return float(np.ptp(hull @ normals.T, axis=0).min()) + 2 * self.radius

    @cached_property
    def symmetry(self) -> int:
        """How many headings look the same: 2 for a rectangle, 4 for a square, 1 for most outlines."""
        if self.is_disc:
            return SYMMETRIES[0]
        shape = shapely.union_all([Polygon(part) for part in self.parts])
        turned = (shapely.affinity.rotate(shape, 360 / order, origin=(0, 0)) for order in SYMMETRIES)
        alike = (shape.symmetric_difference(each).area < 1e-9 * shape.area for each in turned)
        return next((order for order, same in zip(SYMMETRIES, alike, strict=True) if same), 1)

    def scaled(self, factor: float) -> "Robot":
        """The same outline, larger or smaller."""
        return Robot(tuple(part * factor for part in self.parts), self.radius * factor)

    def grown(self, distance: float) -> "Robot":
        """The outline grown by `distance` on all sides; around the corners of polygons in chords inside the arcs."""
        if self.is_disc or distance == 0:
            return Robot(self.parts, self.radius + distance)
        hulls = [Polygon(part).buffer(distance, quad_segs=CHORDS) for part in self.parts]
        return Robot(tuple(np.asarray(shapely.orient_polygons(hull).exterior.coords)[:-1] for hull in hulls))

    def at(self, pose: Floats) -> shapely.Geometry:
        """The outline placed at `pose` (3,); a disc as the polygon inside it of 128 corners."""
        cosine, sine = np.cos(pose[2]), np.sin(pose[2])
        placed = [part @ np.array([[cosine, sine], [-sine, cosine]]) + pose[:2] for part in self.parts]
        if self.is_disc:
            return shapely.Point(placed[0][0]).buffer(self.radius, quad_segs=32)
        return shapely.union_all([Polygon(part).buffer(self.radius) for part in placed])


def parse_robot(text: str) -> Robot:
    """A robot from "disc:RADIUS" or "rectangle:LENGTHxWIDTH", metres."""
    kind, _, numbers = text.partition(":")
    wanted = {"disc": 1, "rectangle": 2}
    if kind not in wanted:
        raise RobotError(f'"{text}" names no robot; say disc:0.2 or rectangle:0.5x0.4')
    try:
        sizes = [float(number) for number in numbers.split("x")]
    except ValueError as trouble:
        raise RobotError(
            f'"{numbers}" in "{text}" is not made of numbers; say disc:0.2 or rectangle:0.5x0.4'
        ) from trouble
    if not np.isfinite(sizes).all():
        raise RobotError(f'"{text}" has a size that is not finite')
    if len(sizes) != wanted[kind]:
        raise RobotError(f'a {kind} has {wanted[kind]} sizes, but "{text}" has {len(sizes)}')
    return Robot.disc(*sizes) if kind == "disc" else Robot.rectangle(*sizes)


def _convex_parts(outline: Floats) -> list[Floats]:
    """Counter-clockwise convex polygons that make up `outline` (k, 2)."""
    if outline.ndim != 2 or outline.shape[1] != 2 or len(outline) < 3 or not np.isfinite(outline).all():
        raise RobotError(f"an outline is three or more finite points (k, 2), but has shape {outline.shape}")
    polygon = Polygon(outline)
    if not polygon.is_valid or polygon.area <= 0:
        raise RobotError(f"an outline of {len(outline)} corners crosses itself or has no area ({polygon.area:g})")
    hull = polygon.convex_hull
    convex = hull.area - polygon.area <= 1e-12 * hull.area
    pieces = [hull] if convex else list(shapely.constrained_delaunay_triangles(polygon).geoms)
    return [shapely.get_coordinates(shapely.orient_polygons(piece))[:-1] for piece in pieces]
