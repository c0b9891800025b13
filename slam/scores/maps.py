"""How good a room map is, against a truth that no estimator ever reads.

Everything is judged inside what the true poses could see; coverage says how much of that the map has.
"""

from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from backend.room_map import MapEdgeKind, RoomMap
from slam.scores.boundaries import BoundaryScores, boundary_scores, edges_of, samples, wall_breach
from slam.scores.objects import DoorScores, ObstacleScores, door_scores, obstacle_scores

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MapTruth:
    """The true free space, the part of it that the true poses could see, true jambs (d, 2, 2) and obstacles."""

    free: BaseGeometry
    seen: BaseGeometry
    doors: Floats
    obstacles: tuple[Polygon, ...]


@dataclass(frozen=True)
class MapScores:
    """Areas in m², shares in 0…1. components: connected parts a disc robot can move in, of the map and of the truth.

    leaks: supported surfaces inside the map's free space (needs no truth).
    """

    iou: float
    coverage: float
    false_free: float
    missed_free: float
    wall_breach: float
    boundary: BoundaryScores
    doors: DoorScores
    obstacles: ObstacleScores
    components: int
    true_components: int
    leaks: int


def score_map(room_map: RoomMap, truth: MapTruth, robot_radius: float = 0.2) -> MapScores:
    """All scores of a map that is in the truth's frame already."""
    free, seen = room_map.free, truth.seen
    common = free.intersection(seen).area
    return MapScores(
        iou=common / free.union(seen).area,
        coverage=common / seen.area,
        false_free=free.difference(truth.free).area,
        missed_free=seen.difference(free).area,
        wall_breach=wall_breach(free, truth.free),
        boundary=boundary_scores(real_edges(room_map), edges_of(truth.free), seen),
        doors=door_scores(room_map.doors, truth.doors),
        obstacles=obstacle_scores(room_map.obstacles, truth.obstacles, truth.free, seen),
        components=_components(free, robot_radius),
        true_components=_components(seen, robot_radius),
        leaks=len(room_map.leaks),
    )


def real_edges(room_map: RoomMap) -> Floats:
    """The edges (e, 2, 2) the map claims to be surface."""
    return np.array([(e.start, e.end) for e in room_map.edges if e.kind == MapEdgeKind.REAL]).reshape(-1, 2, 2)


def best_alignment(room_map: RoomMap, truth: MapTruth, rounds: int = 20) -> Floats:
    """The small rigid motion (3,) that lays the map's surfaces best on the true ones: robust point to line."""
    points, edges = samples(real_edges(room_map)), edges_of(truth.free)
    target = samples(edges)
    number = np.maximum(np.round(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1) / 0.02), 1).astype(np.int64)
    along = np.repeat(edges[:, 1] - edges[:, 0], number, axis=0)
    normals = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
    tree, pose = cKDTree(target), np.zeros(3)
    for _ in range(rounds):
        placed = _placed(points, pose)
        _, nearest = tree.query(placed)
        residual = np.sum((placed - target[nearest]) * normals[nearest], axis=1)
        arm = placed - pose[:2]
        turn = arm[:, 0] * normals[nearest, 1] - arm[:, 1] * normals[nearest, 0]
        jacobian = np.column_stack([normals[nearest], turn])
        weight = 1 / (1 + (residual / 0.05) ** 2)
        hessian = jacobian.T @ (weight[:, None] * jacobian) + 1e-9 * np.eye(3)
        pose = pose - np.linalg.solve(hessian, jacobian.T @ (weight * residual))
    return pose


def moved(room_map: RoomMap, pose: Floats) -> RoomMap:
    """The map with everything in it moved rigidly by a pose (3,)."""

    def point(xy: tuple[float, float]) -> tuple[float, float]:
        x, y = _placed(np.array([xy]), pose)[0]
        return float(x), float(y)

    return replace(
        room_map,
        free=shapely.transform(room_map.free, lambda xy: _placed(xy, pose)),
        safety=shapely.transform(room_map.safety, lambda xy: _placed(xy, pose)),
        edges=tuple(replace(edge, start=point(edge.start), end=point(edge.end)) for edge in room_map.edges),
        doors=tuple(replace(door, jambs=_placed(door.jambs, pose)) for door in room_map.doors),
        obstacles=tuple(
            replace(thing, outline=shapely.transform(thing.outline, lambda xy: _placed(xy, pose)))
            for thing in room_map.obstacles
        ),
        leaks=_placed(room_map.leaks, pose),
        decisions=tuple(replace(made, piece=_placed(made.piece, pose)) for made in room_map.decisions),
    )


def _placed(points: Floats, pose: Floats) -> Floats:
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    return np.asarray(points @ np.array([[cosine, sine], [-sine, cosine]]) + pose[:2])


def _components(free: BaseGeometry, radius: float) -> int:
    """Connected parts a disc's centre can move in, each of 1 dm² or more."""
    return sum(part.area >= 0.01 for part in shapely.get_parts(free.buffer(-radius)))
