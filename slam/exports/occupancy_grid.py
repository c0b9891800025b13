"""The map as an occupancy grid: a PGM picture and the YAML beside it, as map servers read them in trinary mode."""

from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString

from backend.room_map import Floats, MapEdgeKind, RoomMap
from slam.exports.product import Product

CELL = 0.05  # metres: what map servers use most
MARGIN = 10  # cells of unknown around everything
FREE, UNKNOWN, OCCUPIED = 254, 205, 0  # what a map server itself writes for the three


def write_grid(product: Product, path: Path) -> None:
    """The picture at `path`, and its facts beside it."""
    picture, origin = occupancy_grid(product.room, CELL)
    rows, columns = picture.shape
    path.write_bytes(f"P5\n{columns} {rows}\n255\n".encode() + picture.tobytes())
    facts = [
        f"image: {path.name}",
        "mode: trinary",
        f"resolution: {CELL}",
        f"origin: [{origin[0]:.6f}, {origin[1]:.6f}, 0.0]",
        "negate: 0",
        "occupied_thresh: 0.65",
        "free_thresh: 0.196",
    ]
    path.with_suffix(".yaml").write_text("\n".join(facts) + "\n", encoding="utf-8")


def occupancy_grid(room: RoomMap, cell: float) -> tuple[NDArray[np.uint8], Floats]:
    """The picture (rows, columns), top row first, and the place (2,) of its lower left corner.

    A cell is free if its middle is; every cell that a real edge or an obstacle's outline crosses is occupied.
    """
    low, high = np.reshape(room.free.bounds, (2, 2))
    origin = (np.floor(low / cell) - MARGIN) * cell
    columns, rows = np.ceil((high - origin) / cell).astype(int) + MARGIN
    x, y = (origin[:, None] + cell * (np.arange(max(columns, rows)) + 0.5))[:, :]
    picture = np.full((rows, columns), UNKNOWN, np.uint8)
    shapely.prepare(room.free)
    picture[shapely.contains_xy(room.free, x[None, :columns], y[:rows, None])] = FREE
    for line in _surfaces(room):
        column, row = np.floor((_along(line, cell / 4) - origin) / cell).astype(int).T
        picture[row, column] = OCCUPIED
    return picture[::-1], origin


def _surfaces(room: RoomMap) -> list[LineString]:
    walls = [LineString([edge.start, edge.end]) for edge in room.edges if edge.kind is MapEdgeKind.REAL]
    return walls + [LineString(body.outline.exterior.coords) for body in room.obstacles]


def _along(line: LineString, step: float) -> Floats:
    """(n, 2) points along a line, at most `step` apart."""
    return shapely.get_coordinates(shapely.segmentize(line, step))
