"""Spines of generalized cones: the lines midway between two walls that face each other (Brooks 1983).

All pairs of edges are compared. A pair is kept if its normals point against each other, each edge has an end in front
of the other, their projections on the bisector overlap, and the cone is somewhere as wide as the robot. Past the end
of an edge the side goes on parallel to the spine, and the spine goes on until an obstacle cuts it.
"""

import numpy as np
import shapely
from numpy.typing import NDArray

from planners.cells import inside
from planners.compiled import compiled, kernel
from planners.insertion import order_of
from planners.world import World

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

SAMPLES = 12  # places along the overlap where a cone's own walls may be the nearest


def faces_of(world: World, tolerance: float) -> tuple[Floats, Floats]:
    """The walls as cones are made from them: faces (f, 4) with their lines (f, 3), unit normals and offsets.

    Corners that stand out by less than `tolerance` metres are left out: each of their edges would face every other
    across the room. Only spines come from faces; what is legal on them is asked of the walls themselves.
    """
    rings = [
        shapely.get_coordinates(ring)
        for ring in shapely.get_rings(shapely.get_parts(shapely.simplify(world.free, tolerance)))
    ]
    ends = np.concatenate([np.column_stack([ring[:-1], ring[1:]]) for ring in rings])
    along = ends[:, 2:] - ends[:, :2]
    normals = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    return ends, np.column_stack([normals, np.einsum("ij,ij->i", normals, ends[:, :2])])


@compiled
def facing_pairs(ends: Floats, lines: Floats) -> Ints:
    """Pairs (k, 2) of edges that face each other, each with an end strictly in front of the other's line."""
    total = ends.shape[0]
    pairs = np.empty((total * (total - 1) // 2, 2), dtype=np.int32)
    count = 0
    for i in range(total):
        x, y, c = lines[i, 0], lines[i, 1], lines[i, 2]
        for j in range(i + 1, total):
            if x * lines[j, 0] + y * lines[j, 1] >= 0:
                continue
            if max(x * ends[j, 0] + y * ends[j, 1], x * ends[j, 2] + y * ends[j, 3]) <= c:
                continue
            u, v, d = lines[j, 0], lines[j, 1], lines[j, 2]
            if max(u * ends[i, 0] + v * ends[i, 1], u * ends[i, 2] + v * ends[i, 3]) <= d:
                continue
            pairs[count, 0], pairs[count, 1] = i, j
            count += 1
    return pairs[:count].copy()


@kernel
def _shadow(end: Floats, line: Floats, along: Floats) -> tuple[float, float]:
    """Interval on the spine of the part of an edge (4,) in front of a line (3,): normal and offset."""
    first = line[0] * end[0] + line[1] * end[1] - line[2]
    second = line[0] * end[2] + line[1] * end[3] - line[2]
    begin, stop = 0.0, 1.0
    if first < 0:
        begin = first / (first - second)
    elif second < 0:
        stop = first / (first - second)
    here = along[0] * end[0] + along[1] * end[1]
    there = along[0] * end[2] + along[1] * end[3]
    one, two = here + begin * (there - here), here + stop * (there - here)
    return min(one, two), max(one, two)


@kernel
def bisector(i: int, j: int, ends: Floats, lines: Floats) -> Floats:
    """Spine of a pair (8,): origin, direction, overlap begin and end on it, distance d of the walls as d0 + slope · t.

    lines: (m, 3) normals and offsets. The overlap is empty (begin ≥ end) if the projections do not meet.
    """
    x, y = lines[i, 0] - lines[j, 0], lines[i, 1] - lines[j, 1]
    length = np.hypot(x, y)
    x, y, offset = x / length, y / length, (lines[i, 2] - lines[j, 2]) / length
    along = np.empty(2)
    along[0], along[1] = -y, x
    one, two = _shadow(ends[i], lines[j], along), _shadow(ends[j], lines[i], along)
    spine = np.empty(8)
    spine[0], spine[1], spine[2], spine[3] = offset * x, offset * y, -y, x
    spine[4], spine[5] = max(one[0], two[0]), min(one[1], two[1])
    spine[6] = lines[i, 0] * spine[0] + lines[i, 1] * spine[1] - lines[i, 2]
    spine[7] = lines[i, 0] * spine[2] + lines[i, 1] * spine[3]
    return spine


@kernel
def _cuts(spine: Floats, ends: Floats) -> Floats:
    """Positions on a spine's line, increasing, where an edge crosses or touches it."""
    found = np.empty(2 * ends.shape[0])
    count = 0
    for k in range(ends.shape[0]):
        first = spine[2] * (ends[k, 1] - spine[1]) - spine[3] * (ends[k, 0] - spine[0])
        second = spine[2] * (ends[k, 3] - spine[1]) - spine[3] * (ends[k, 2] - spine[0])
        if (first <= 0) != (second <= 0):
            share = first / (first - second)
            x = ends[k, 0] + share * (ends[k, 2] - ends[k, 0])
            y = ends[k, 1] + share * (ends[k, 3] - ends[k, 1])
            found[count] = spine[2] * (x - spine[0]) + spine[3] * (y - spine[1])
            count += 1
    cuts = found[:count].copy()
    return np.asarray(cuts[order_of(cuts)])


@kernel
def _stands_free(spine: Floats, low: float, high: float, ends: Floats, share: float) -> bool:
    """Whether somewhere between two positions no wall is nearer than `share` of the distance of the cone's own."""
    for sample in range(SAMPLES):
        position = low + (high - low) * (sample + 0.5) / SAMPLES
        x, y = spine[0] + position * spine[2], spine[1] + position * spine[3]
        least, free = ((spine[6] + position * spine[7]) * share) ** 2, True
        for k in range(ends.shape[0]):
            along_x, along_y = ends[k, 2] - ends[k, 0], ends[k, 3] - ends[k, 1]
            to_x, to_y = x - ends[k, 0], y - ends[k, 1]
            along = (to_x * along_x + to_y * along_y) / (along_x * along_x + along_y * along_y)
            along = min(max(along, 0.0), 1.0)
            if (to_x - along * along_x) ** 2 + (to_y - along * along_y) ** 2 < least:
                free = False
                break
        if free:
            return True
    return False


@compiled
def spines(pairs: Ints, faces: Floats, lines: Floats, ends: Floats, width: float, share: float) -> Floats:
    """Rows (k, 8): both ends of a free run of a spine, its faces i and j, and the overlap's begin and end along it.

    faces (f, 4) with their lines (f, 3) make the spines, walls (m, 4) from `ends` to end cut them. Several rows for a
    pair whose spine is cut within the overlap; none if it is nowhere `width` wide.
    """
    rows = np.empty((pairs.shape[0] + 16, 8))
    count = 0
    for k in range(pairs.shape[0]):
        spine = bisector(pairs[k, 0], pairs[k, 1], faces, lines)
        widest = 2 * (spine[6] + max(spine[7] * spine[4], spine[7] * spine[5]))
        if spine[4] >= spine[5] or widest < width:
            continue
        cuts = _cuts(spine, ends)
        for run in range(cuts.size - 1):
            low, high = max(cuts[run], spine[4]), min(cuts[run + 1], spine[5])
            begin, stop = cuts[run], cuts[run + 1]
            if low >= high or stop - begin < width / 2:
                continue
            middle = (low + high) / 2
            if not inside(ends, spine[0] + middle * spine[2], spine[1] + middle * spine[3]):
                continue
            if not _stands_free(spine, low, high, ends, share):
                continue
            if count == rows.shape[0]:
                rows = np.concatenate((rows, np.empty_like(rows)))
            rows[count, 0], rows[count, 1] = spine[0] + begin * spine[2], spine[1] + begin * spine[3]
            rows[count, 2], rows[count, 3] = spine[0] + stop * spine[2], spine[1] + stop * spine[3]
            rows[count, 4], rows[count, 5] = pairs[k, 0], pairs[k, 1]
            rows[count, 6], rows[count, 7] = low - begin, high - begin
            count += 1
    return rows[:count].copy()
