"""The next best view: from where the most frontier would turn into map, for the way it costs."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from backend.room_map import MapEdgeKind, RoomMap

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class NextViewSettings:
    """Opinions about where to look next."""

    raster: float = 0.5  # metres between candidate places; smaller searches finer and longer
    spacing: float = 0.10  # metres between frontier points; smaller counts short frontiers better
    least: float = 0.30  # metres of frontier worth a look; larger stops exploring earlier
    farthest: float = 6.0  # metres; larger counts on frontier seen from farther away, and searches longer
    way: float = 0.10  # metres of frontier a metre of way must bring; larger stays nearer


@dataclass(frozen=True, eq=False)
class NextView:
    """Where to look next: pose (3,), metres of frontier it would see, and the points (p, 2) of that frontier."""

    pose: Floats
    gain: float
    frontier: Floats


def next_view(room_map: RoomMap, pose: Floats, reach: float, settings: NextViewSettings) -> NextView | None:
    """The best next pose for a sensor that reaches `reach` metres, coming from `pose` (3,); None: nothing left."""
    frontier, inward = _frontier_points(room_map, settings.spacing)
    places = _places(room_map, settings.raster)
    if not len(frontier) or not len(places):
        return None
    cost = settings.way * np.linalg.norm(places - pose[:2], axis=1)
    best = _best(room_map, places, cost, (frontier, inward), min(reach, settings.farthest), settings)
    if best is None:
        return None
    place, seen = best
    ahead = frontier[seen].mean(axis=0) - place
    gain = float(np.count_nonzero(seen) * settings.spacing)
    return NextView(np.array([*place, np.arctan2(ahead[1], ahead[0])]), gain, frontier[seen])


def _best(
    room_map: RoomMap,
    places: Floats,
    cost: Floats,
    frontier: tuple[Floats, Floats],
    reach: float,
    settings: NextViewSettings,
) -> tuple[Floats, NDArray[np.bool_]] | None:
    """The place (2,) that is worth most and what it sees (p,), the most promising places looked at first."""
    promised = _ahead(places, frontier, reach)
    bound = promised.sum(axis=1) * settings.spacing - cost
    best, most = None, -np.inf
    shapely.prepare(room_map.free)
    for place in np.argsort(-bound):
        if bound[place] <= most:
            break
        seen = _sees(room_map, places[place], frontier, promised[place])
        gain = np.count_nonzero(seen) * settings.spacing
        if gain >= settings.least and gain - cost[place] > most:
            best, most = (places[place], seen), gain - cost[place]
    return best


def _frontier_points(room_map: RoomMap, spacing: float) -> tuple[Floats, Floats]:
    """Points (p, 2) along the frontier edges, and their normals (p, 2) into the free space."""
    edges = [(e.start, e.end) for e in room_map.edges if e.kind == MapEdgeKind.FRONTIER]
    points, normals = [np.empty((0, 2))], [np.empty((0, 2))]
    for start, end in np.array(edges).reshape(-1, 2, 2):
        length = float(np.linalg.norm(end - start))
        count = int(length / spacing + 0.5)
        points.append(start + (np.arange(count)[:, None] + 0.5) / max(count, 1) * (end - start))
        normals.append(np.tile(np.array([start[1] - end[1], end[0] - start[0]]) / max(length, 1e-9), (count, 1)))
    return np.concatenate(points), np.concatenate(normals)


def _places(room_map: RoomMap, raster: float) -> Floats:
    """Places (c, 2) on a raster inside the safety layer."""
    if room_map.safety.is_empty:
        return np.empty((0, 2))
    x0, y0, x1, y1 = room_map.safety.bounds
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(x0, x1, raster), np.arange(y0, y1, raster)))
    shapely.prepare(room_map.safety)
    inside = shapely.contains_xy(room_map.safety, x, y)
    return np.stack([x[inside], y[inside]], axis=1)


def _ahead(places: Floats, frontier: tuple[Floats, Floats], reach: float) -> NDArray[np.bool_]:
    """Which frontier points (p,) lie within reach of each place (c,) and are not seen at a grazing angle."""
    points, inward = frontier
    ray = places[:, None] - points[None]
    distance = np.linalg.norm(ray, axis=2)
    return np.asarray((distance < reach) & (np.sum(ray * inward[None], axis=2) > 0.2 * distance))


def _sees(
    room_map: RoomMap, place: Floats, frontier: tuple[Floats, Floats], promised: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Which of the promised frontier points (p,) the place (2,) sees through free space."""
    points, inward = (part[promised] for part in frontier)
    lines = shapely.linestrings(np.stack([points + 0.03 * inward, np.broadcast_to(place, points.shape)], axis=1))
    seen = promised.copy()
    seen[promised] = shapely.covers(room_map.free, lines)
    return seen
