"""Views of known floor plans: a small ray caster and a generator of furnished plans, for tests and benchmarks."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon, Point, Polygon, box
from shapely.affinity import rotate

from backend.contours import as_polygons
from backend.view import EdgeKind, View

Floats = NDArray[np.float64]
WALL = 0.10


@dataclass(frozen=True, eq=False)
class Plan:
    """Free space with its doors (d, 2, 2) and the obstacles that were cut out of it."""

    free: Polygon
    doors: Floats
    obstacles: tuple[Polygon, ...]


@dataclass(frozen=True)
class Rays:
    """A lidar: beams over the field of view (radians), range limit and noise in metres."""

    beams: int = 360
    field: float = 2 * np.pi
    max_range: float = 10.0
    noise: float = 0.02


def empty_room(width: float = 6.0, height: float = 4.0) -> Plan:
    """One rectangular room with a corner at the origin."""
    return Plan(box(0, 0, width, height), np.empty((0, 2, 2)), ())


def furnished_plan(rng: np.random.Generator, rooms: int, obstacles: int | None = None) -> Plan:
    """`rooms` rectangular rooms that share 10 cm walls, joined by doors 0.8–1.0 m wide, with furniture."""
    cells = _split(rng, rooms)
    pieces = [box(x0 + WALL / 2, y0 + WALL / 2, x1 - WALL / 2, y1 - WALL / 2) for x0, y0, x1, y1 in cells]
    doors, gaps = _doors(rng, cells)
    count = int(1.5 * rooms) if obstacles is None else obstacles
    things: list[Polygon] = []
    clear = shapely.union_all([gap.buffer(0.6) for gap in gaps]) if gaps else Polygon()
    while len(things) < count:
        thing = _furniture(rng, pieces[rng.integers(len(pieces))])
        apart = all(thing.distance(other) > 0.6 for other in things)
        if apart and not thing.intersects(clear):
            things.append(thing)
    free = (
        shapely.union_all(pieces + gaps).difference(shapely.union_all(things))
        if things
        else shapely.union_all(pieces + gaps)
    )
    assert isinstance(free, Polygon)
    return Plan(free, doors, tuple(things))


def _split(rng: np.random.Generator, rooms: int) -> list[tuple[float, float, float, float]]:
    """Cut a rectangle into `rooms` rectangles, the largest first, across its longer side."""
    scale = np.sqrt(rooms * 14.0)
    cells = [(0.0, 0.0, float(scale * 1.2), float(scale / 1.2))]
    while len(cells) < rooms:
        x0, y0, x1, y1 = cells.pop(int(np.argmax([(c[2] - c[0]) * (c[3] - c[1]) for c in cells])))
        share = rng.uniform(0.4, 0.6)
        if x1 - x0 > y1 - y0:
            cut = x0 + share * (x1 - x0)
            cells += [(x0, y0, cut, y1), (cut, y0, x1, y1)]
        else:
            cut = y0 + share * (y1 - y0)
            cells += [(x0, y0, x1, cut), (x0, cut, x1, y1)]
    return cells


def _doors(rng: np.random.Generator, cells: list[tuple[float, float, float, float]]) -> tuple[Floats, list[Polygon]]:
    """Doors that join all rooms (a random spanning tree and a few more): jambs and the gaps in the walls."""
    joined = list(range(len(cells)))
    jambs: list[list[list[float]]] = []
    gaps: list[Polygon] = []
    pairs = [(i, j) for i in range(len(cells)) for j in range(i + 1, len(cells))]
    for pair in rng.permutation(len(pairs)):
        i, j = pairs[pair]
        shared = _shared_wall(cells[i], cells[j])
        if shared is None or (joined[i] == joined[j] and rng.random() > 0.2):
            continue
        joined = [joined[i] if group == joined[j] else group for group in joined]
        axis, level, low, high = shared
        width = rng.uniform(0.8, 1.0)
        start = rng.uniform(low + 0.2, high - 0.2 - width)
        ends = [[start, level], [start + width, level]]
        jambs.append(ends if axis == 0 else [[level, start], [level, start + width]])
        across = WALL / 2 + 1e-9
        gap = (start, level - across, start + width, level + across)
        gaps.append(box(*gap) if axis == 0 else box(gap[1], gap[0], gap[3], gap[2]))
    return np.array(jambs).reshape(-1, 2, 2), gaps


def _shared_wall(a: tuple[float, ...], b: tuple[float, ...]) -> tuple[int, float, float, float] | None:
    """Axis along which the shared wall runs, its level, and its two ends; None without 1.6 m in common."""
    for axis in (0, 1):
        across = 1 - axis
        low, high = max(a[axis], b[axis]), min(a[axis + 2], b[axis + 2])
        for level, other in ((a[across + 2], b[across]), (b[across + 2], a[across])):
            if abs(level - other) < 1e-9 and high - low > 1.6:
                return axis, level, low, high
    return None


def _furniture(rng: np.random.Generator, room: Polygon) -> Polygon:
    """A turned box or a round thing, inside the room or against one of its walls."""
    x0, y0, x1, y1 = room.bounds
    width, depth = rng.uniform(0.3, 1.0, 2)
    if rng.random() < 0.4:  # a cupboard against the wall
        x = rng.uniform(x0, x1 - width)
        return box(x, y0, x + width, y0 + depth / 2) if rng.random() < 0.5 else box(x, y1 - depth / 2, x + width, y1)
    inside = room.buffer(-1.0)
    ix0, iy0, ix1, iy1 = inside.bounds if not inside.is_empty else room.centroid.buffer(0.1).bounds
    x, y = rng.uniform(ix0, ix1), rng.uniform(iy0, iy1)
    if rng.random() < 0.4:
        return Point(x, y).buffer(width / 2.5)
    turned: Polygon = rotate(box(x - width / 2, y - depth / 2, x + width / 2, y + depth / 2), rng.uniform(0, 90))
    return turned


def segments_of(free: Polygon) -> Floats:
    """All boundary edges (s, 2, 2) of a polygon with holes."""
    rings = [np.asarray(ring.coords) for ring in (free.exterior, *free.interiors)]
    return np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])


def cast(segments: Floats, pose: Floats, bearings: Floats) -> Floats:
    """True ranges (n,) along the bearings from a pose (3,); inf where nothing is hit."""
    angles = pose[2] + bearings
    along = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    start = segments[:, 0] - pose[:2]
    edge = segments[:, 1] - segments[:, 0]
    across = along[:, None, 0] * edge[None, :, 1] - along[:, None, 1] * edge[None, :, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = (start[:, 0] * edge[:, 1] - start[:, 1] * edge[:, 0]) / across
        share = (start[None, :, 0] * along[:, None, 1] - start[None, :, 1] * along[:, None, 0]) / across
    hit = (reach > 1e-9) & (share >= -1e-9) & (share <= 1 + 1e-9)
    return np.asarray(np.where(hit, reach, np.inf).min(axis=1))


def view_of(plan: Plan, pose: Floats, rays: Rays, rng: np.random.Generator) -> View:
    """What a lidar at the true pose (3,) sees of the plan."""
    full = rays.field >= 2 * np.pi - 1e-9
    bearings = np.linspace(-rays.field / 2, rays.field / 2, rays.beams, endpoint=not full)
    ranges = cast(segments_of(plan.free), pose, bearings)
    ranges = np.where(ranges < rays.max_range, ranges + rng.normal(0, rays.noise, rays.beams), np.inf)
    return view_from_ranges(bearings, ranges, rays)


def view_from_ranges(bearings: Floats, ranges: Floats, rays: Rays) -> View:
    """The star-shaped view of one lidar turn; `inf` ranges are cut at the range limit."""
    silent = ~np.isfinite(ranges)
    points = np.where(silent, rays.max_range, ranges)[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=1)
    after = np.roll(points, -1, axis=0)
    edge = after - points
    length = np.linalg.norm(edge, axis=1)
    beam = points / np.linalg.norm(points, axis=1, keepdims=True)
    grazing = np.abs(beam[:, 0] * edge[:, 1] - beam[:, 1] * edge[:, 0]) < np.sin(np.radians(10)) * length
    kinds = np.where(grazing & (length > max(0.1, 4 * rays.noise)), EdgeKind.OCCLUSION, EdgeKind.REAL)
    kinds = np.where(silent | np.roll(silent, -1), EdgeKind.NO_RETURN, kinds)
    spread = np.full(len(points), max(rays.noise, 0.005))
    if rays.field < 2 * np.pi - 1e-9:
        points, spread = np.vstack([points, np.zeros((1, 2))]), np.append(spread, 0.0)
        kinds = np.append(kinds, EdgeKind.SIDE)
        kinds[-2] = EdgeKind.SIDE
    return View(points, kinds.astype(np.uint8), spread, np.zeros(2), np.empty((0, 2, 2)))


def seen_from(plan: Plan, poses: Floats, max_range: float) -> MultiPolygon:
    """The part of the plan's free space in sight of the true poses: rays just beside every corner, and some between."""
    segments = segments_of(plan.free)
    between = np.linspace(-np.pi, np.pi, 120, endpoint=False)
    seen = []
    for pose in poses:
        corner = segments[:, 0] - pose[:2]
        angles = np.arctan2(corner[:, 1], corner[:, 0])
        bearings = np.unique(np.concatenate([angles - 1e-5, angles + 1e-5, between]))
        ranges = np.minimum(cast(segments, np.array([*pose[:2], 0.0]), bearings), max_range)
        ring = ranges[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=1)
        seen.append(shapely.make_valid(Polygon(ring + pose[:2])).simplify(1e-4))
    whole = shapely.make_valid(shapely.union_all(seen)).intersection(plan.free)
    return MultiPolygon([part for part in as_polygons(whole).geoms if part.area > 1e-3])


def scattered_poses(plan: Plan, count: int, rng: np.random.Generator) -> Floats:
    """Poses (count, 3) anywhere in the free space, at least 25 cm from surfaces."""
    roomy = plan.free.buffer(-0.25)
    x0, y0, x1, y1 = roomy.bounds
    poses: list[Floats] = []
    while len(poses) < count:
        x, y = rng.uniform(x0, x1), rng.uniform(y0, y1)
        if roomy.contains(Point(x, y)):
            poses.append(np.array([x, y, rng.uniform(-np.pi, np.pi)]))
    return np.array(poses)


def misplaced(poses: Floats, metres: float, degrees: float, rng: np.random.Generator) -> Floats:
    """The poses (n, 3) with Gaussian errors."""
    return np.asarray(poses + rng.normal(0, 1, poses.shape) * np.array([metres, metres, np.radians(degrees)]))
