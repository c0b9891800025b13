"""Worlds of known truth for the tests of pose estimation: lidar scans of simulated rooms, and drives through them."""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from shapely import Polygon, box
from shapely.geometry import mapping

from frontend.contour import ContourSettings, trace
from frontend.fusion import FusedScan, FusionSettings, fuse
from frontend.local_map import Faces
from frontend.scan import Floats, Scan
from frontend.sensors.lidar import LIDAR
from frontend.surface import Surface
from slam.simulation.record import SENSORS, lidar_scan
from slam.simulation.trajectory import WheelNoise, wheel_odometry
from slam.simulation.world import World, build_world

BEARINGS = np.array(SENSORS["lidar"].bearings)


def world_of(boundary: Polygon, *solids: Polygon) -> World:
    """The inside of a boundary, less some solids."""
    features = [_feature(boundary, "boundary"), *(_feature(solid, "obstacle") for solid in solids)]
    return build_world({"features": features})


def _feature(shape: Polygon, kind: str) -> dict[str, Any]:
    geometry = json.loads(json.dumps(mapping(shape)))
    return {"type": "Feature", "properties": {"kind": kind}, "geometry": geometry}


def furnished_room(rng: np.random.Generator) -> World:
    """A room of random size with four boxes of random place and size along its walls; the middle stays free."""
    width, depth = rng.uniform(5, 8, 2)
    sizes = rng.uniform(0.4, 1.0, (4, 2))
    along = rng.uniform(0.3, 0.6, 4)
    boxes = [
        box(along[0] * width, 0, along[0] * width + sizes[0, 0], sizes[0, 1]),
        box(along[1] * width, depth - sizes[1, 1], along[1] * width + sizes[1, 0], depth),
        box(0, along[2] * depth, sizes[2, 0], along[2] * depth + sizes[2, 1]),
        box(width - sizes[3, 0], along[3] * depth, width, along[3] * depth + sizes[3, 1]),
    ]
    return world_of(box(0, 0, width, depth), *boxes)


def corridor() -> World:
    """Two parallel walls of 60 m, 2 m apart: longer than any lidar sees."""
    return world_of(box(0, 0, 60, 2))


def round_building() -> World:
    """A corridor 2.4 m wide round a block of 7.2 × 4.2 m, with pilasters so that no part of it slides."""
    pilasters = [(5, 0, 5.5, 0.4), (11.4, 3, 12, 4), (7, 8.6, 8.2, 9), (0, 5, 0.5, 5.6), (3.6, 2.2, 4.2, 2.5)]
    return world_of(box(0, 0, 12, 9), box(2.4, 2.4, 9.6, 6.6), *(box(*corners) for corners in pilasters))


def once_round(step: float = 0.3, beyond: float = 3.0) -> Floats:
    """True poses (p, 3) round that block with rounded corners, and some metres beyond the start."""
    outline = box(1.2, 1.2, 10.8, 7.8).buffer(-0.8).buffer(0.8).exterior.normalize()
    lane = shapely.LineString(np.array(outline.coords)[::-1])
    along = np.arange(0.0, lane.length + beyond, step) % lane.length
    places, ahead = (np.array([lane.interpolate(at).coords[0] for at in along + shift]) for shift in (0.0, 0.01))
    return np.column_stack([places, np.arctan2(*(ahead - places).T[::-1])])


def drive(world: World, poses: Floats, seed: int, wheels: WheelNoise | None = None) -> list[Scan]:
    """Lidar scans from true poses (p, 3), with the odometry of noisy wheels, two a second."""
    rng = np.random.default_rng(seed)
    odometry = wheel_odometry(poses, wheels or WheelNoise(), rng)
    return [
        Scan(BEARINGS, lidar_scan(world, pose, LIDAR, rng), LIDAR, believed, 0.5 * number)
        for number, (pose, believed) in enumerate(zip(poses, odometry, strict=True))
    ]


def fused_at(world: World, pose: Floats, rng: np.random.Generator) -> FusedScan:
    """One scan from a pose (3,), fused."""
    ranges = lidar_scan(world, np.asarray(pose), LIDAR, rng)
    return fuse(Scan(BEARINGS, ranges, LIDAR, np.zeros(3), 0.0), FusionSettings())


def surface_at(world: World, pose: Floats, rng: np.random.Generator) -> Surface:
    """The surface of one scan from a pose (3,), in the robot's frame."""
    return trace(fused_at(world, pose, rng), ContourSettings()).surface()


def faces_from(world: World, poses: Sequence[Floats], rng: np.random.Generator) -> Faces:
    """Faces seen from true poses, placed there."""
    return Faces.together([Faces.placed(surface_at(world, pose, rng), np.asarray(pose)) for pose in poses])
