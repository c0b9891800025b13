"""Rooms whose scans are computed here, independently of the simulator: rays cast into polygons, a beam as a minimum."""

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from frontend.contour import Contour, ContourSettings, trace
from frontend.fusion import FusionSettings, fuse
from frontend.primal_sketch import PrimalSketch, SketchSettings, sketch
from frontend.rigid_motion import transform
from frontend.scan import Floats, Integers, Scan, Sensor

LIDAR = Sensor("lidar", max_range=30.0, range_noise=0.01)
L_ROOM = Polygon([(0, 0), (6, 0), (6, 2.5), (3.5, 2.5), (3.5, 5), (0, 5)])
FURNISHED = Polygon(
    [(0, 0), (8, 0), (8, 6), (5, 6), (5, 5.2), (4, 5.2), (4, 6), (0, 6)],
    [[(1.5, 3), (2.5, 3), (2.5, 4), (1.5, 4)], [(5.5, 2), (6.2, 2), (6.2, 2.6), (5.5, 2.6)]],
)


def turn(n: int) -> Floats:
    """n bearings of a full turn, starting at −π."""
    return -np.pi + 2 * np.pi * np.arange(n) / n


def true_ranges(room: BaseGeometry, pose: Floats, bearings: Floats) -> tuple[Floats, Integers]:
    """Range (n,) along each bearing to the walls of the room, and which wall (n,) it met."""
    rings = [np.asarray(ring.coords) for ring in shapely.get_rings(shapely.get_parts(room))]
    starts = np.vstack([ring[:-1] for ring in rings]) - pose[:2]
    along = np.vstack([np.diff(ring, axis=0) for ring in rings])
    beams = np.column_stack([np.cos(bearings + pose[2]), np.sin(bearings + pose[2])])
    across = beams[:, None, 0] * along[None, :, 1] - beams[:, None, 1] * along[None, :, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = (starts[:, 0] * along[:, 1] - starts[:, 1] * along[:, 0])[None] / across
        share = (starts[None, :, 0] * beams[:, None, 1] - starts[None, :, 1] * beams[:, None, 0]) / across
    reach = np.where((share >= -1e-12) & (share <= 1 + 1e-12) & (reach > 1e-9), reach, np.inf)
    return np.min(reach, axis=1), np.argmin(reach, axis=1)


def first_echoes(ranges: Floats, half_beam: float) -> Floats:
    """The nearest of the evenly spaced full-turn ranges (n,) within the half-beam: what a wide beam reads."""
    reach = int(np.floor(half_beam / (2 * np.pi / ranges.size) + 1e-9))
    return np.asarray(np.min(np.stack([np.roll(ranges, k) for k in range(-reach, reach + 1)]), axis=0))


def lidar_scan(room: BaseGeometry, pose: Floats, n: int = 360, noise: float = 0.01, seed: int = 0) -> Scan:
    """A full turn of a lidar in the room."""
    bearings = turn(n)
    ranges, _ = true_ranges(room, pose, bearings)
    noisy = ranges + np.random.default_rng(seed).normal(0.0, noise, n)
    return Scan(bearings, noisy, LIDAR, np.zeros(3), 0.0)


def traced(room: BaseGeometry, pose: Floats, n: int = 360, noise: float = 0.01, seed: int = 0) -> Contour:
    """The contour of a lidar's turn."""
    return trace(fuse(lidar_scan(room, pose, n, noise, seed), FusionSettings()), ContourSettings())


def sketched(room: BaseGeometry, pose: Floats, seed: int = 0) -> PrimalSketch:
    """The primal sketch of a lidar's turn."""
    return sketch(traced(room, pose, seed=seed), SketchSettings())


def corners_of(room: BaseGeometry, pose: Floats) -> Floats:
    """The room's corners (c, 2) in the robot's frame."""
    corners = np.vstack([np.asarray(ring.coords)[:-1] for ring in shapely.get_rings(shapely.get_parts(room))])
    return transform(corners - pose[:2], np.array([0.0, 0.0, -pose[2]]))
