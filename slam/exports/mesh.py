"""The map as a mesh: the floor, and every real edge and obstacle extruded to a wall.

trimesh writes the files: what open3d 0.20 writes as GLB, neither it nor other readers of glTF can load.
"""

from pathlib import Path

import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray
from shapely import Polygon

from backend.room_map import Floats, MapEdgeKind, RoomMap
from slam.exports.product import Product

WALL_HEIGHT = 2.5  # metres: a common storey; the sensors of one plane cannot know it
OBSTACLE_HEIGHT = 1.0
FLOOR, WALL, BODY = (0.86, 0.91, 0.96), (0.35, 0.35, 0.37), (0.55, 0.45, 0.70)
Triangles = NDArray[np.int32]
Sheet = tuple[Floats, Triangles, tuple[float, float, float]]


def write_mesh(product: Product, path: Path) -> None:
    """GLB or PLY, by the path's suffix; z is up, one unit is a metre."""
    corners, triangles, colours = mesh(product.room)
    shades = np.round(255 * colours).astype(np.uint8)
    trimesh.Trimesh(corners, triangles, vertex_colors=shades, process=False).export(path)


def mesh(room: RoomMap) -> tuple[Floats, Triangles, Floats]:
    """Corners (c, 3), triangles (t, 3) counter-clockwise seen from free space, and colours (c, 3) in 0…1."""
    real = [np.array([edge.start, edge.end]) for edge in room.edges if edge.kind is MapEdgeKind.REAL]
    bodies = [shapely.orient_polygons(obstacle.outline, exterior_cw=True) for obstacle in room.obstacles]
    rings = [shapely.get_coordinates(ring) for body in bodies for ring in [body.exterior, *body.interiors]]
    sheets: list[Sheet] = [
        *(_flat(part, 0.0, FLOOR) for part in room.free.geoms),
        *(_upright(edge, WALL_HEIGHT, WALL) for edge in real),
        *(_flat(body, OBSTACLE_HEIGHT, BODY) for body in bodies),
        *(_upright(ring, OBSTACLE_HEIGHT, BODY) for ring in rings),
    ]
    counts = np.cumsum([0] + [len(corners) for corners, _, _ in sheets])
    return (
        np.concatenate([corners for corners, _, _ in sheets]),
        np.concatenate([triangles + first for (_, triangles, _), first in zip(sheets, counts[:-1], strict=True)]),
        np.concatenate([np.tile(colour, (len(corners), 1)) for corners, _, colour in sheets]),
    )


def _flat(shape: Polygon, height: float, colour: tuple[float, float, float]) -> Sheet:
    """The shape as triangles at a height, facing up."""
    parts = shapely.get_parts(shapely.constrained_delaunay_triangles(shape))
    rings = shapely.get_coordinates(shapely.orient_polygons(parts)).reshape(-1, 4, 2)[:, :3]
    corners = np.column_stack([rings.reshape(-1, 2), np.full(3 * len(rings), height)])
    return corners, np.arange(len(corners), dtype=np.int32).reshape(-1, 3), colour


def _upright(line: Floats, height: float, colour: tuple[float, float, float]) -> Sheet:
    """A strip of rectangles over a line (k, 2), facing its left."""
    k = len(line)
    corners = np.column_stack([np.tile(line, (2, 1)), np.repeat([0.0, height], k)])
    here = np.arange(k - 1, dtype=np.int32)
    there, over, across = here + 1, here + k, here + k + 1
    return corners, np.concatenate([np.c_[there, here, over], np.c_[there, over, across]]).astype(np.int32), colour
