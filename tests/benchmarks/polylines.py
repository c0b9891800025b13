"""Reference simplifications of one scan: Douglas–Peucker, Visvalingam, split and merge, maximum likelihood.

Each takes the ends of a scan's rays (n, 2) in order, the sensor at the origin, whether each end and the next may lie
on one line (n,), and the number of vertices to keep. They are the peers of the front end's benchmark and no part of
the product.

The yardstick is that of Schaefer, Büscher, Luft & Burgard (2018): a scan is drawn as a set of polylines, broken where
neighbouring ends lie more than a metre apart or a ray between them is lost; every vertex counts, the ends of a polyline
too; the error is the root mean square along those rays that meet a line. On these terms the known figures of all four
come out together (0.36, 0.17 and 0.07 m of Douglas–Peucker and Visvalingam); as one line through every return, drawn
across every occlusion, none of them comes near its own. As leaving hard rays undrawn flatters a method, the share of
rays drawn must be read beside the error.
"""

import heapq

import numpy as np

from frontend.best_polylines import Polylines
from frontend.scan import Booleans, Floats, Integers

BREAK = 1.0  # metres that two ends on one line may lie apart, as in the published experiments


def may_join(rays: Floats, beams: Integers) -> Booleans:
    """Whether each ray's end and the next may lie on one line (n,). beams: (n,) the number of each ray in the scan."""
    near = np.hypot(*np.diff(rays, axis=0).T) <= BREAK
    return np.append(near & (np.diff(beams) == 1), False)


def radial_errors(rays: Floats, lines: Polylines) -> Floats:
    """How much longer each ray (n,) is than its polyline says, nan where none is drawn."""
    errors = np.full(rays.shape[0], np.nan)
    for first, last in runs_of(lines.joined):
        drawn = slice(lines.rays[first], lines.rays[last] + 1)
        errors[drawn] = misses(rays[drawn], lines.vertices[first : last + 1])
    return errors


def misses(rays: Floats, polyline: Floats) -> Floats:
    """How much longer each ray (n,) is than the one polyline (v, 2) over it says."""
    bearings, corners = _bearings(rays), _bearings(polyline)
    edge = np.clip(np.searchsorted(corners, bearings - 1e-12), 1, polyline.shape[0] - 1)
    start, along = polyline[edge - 1], polyline[edge] - polyline[edge - 1]
    across = np.cos(bearings) * along[:, 1] - np.sin(bearings) * along[:, 0]
    reach = (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / across
    return np.asarray(np.hypot(rays[:, 0], rays[:, 1]) - reach)


def _bearings(points: Floats) -> Floats:
    return np.unwrap(np.arctan2(points[:, 1], points[:, 0]))


def runs_of(joined: Booleans) -> list[tuple[int, int]]:
    """First and last index of each run of two or more that are joined."""
    lasts = np.flatnonzero(~joined)
    firsts = np.concatenate([[0], lasts[:-1] + 1])
    return [(int(i), int(j)) for i, j in zip(firsts, lasts, strict=True) if j > i]


def longest_runs(joined: Booleans, count: int) -> list[tuple[int, int]]:
    """The runs with the most rays, as many as have vertices enough for their two ends, in order."""
    runs = sorted(runs_of(joined), key=lambda run: run[0] - run[1])
    return sorted(runs[: count // 2])


def _drawn(rays: Floats, kept: Integers, runs: list[tuple[int, int]]) -> Polylines:
    ends = np.array([last for _, last in runs])
    return Polylines(rays[kept], kept, ~np.isin(kept, ends))


def douglas_peucker(rays: Floats, joined: Booleans, count: int) -> Polylines:
    """Keep splitting the chord whose farthest point lies farthest off, until there are so many vertices."""
    runs = longest_runs(joined, count)
    return _drawn(rays, _split_farthest(rays, runs, count), runs)


def _split_farthest(rays: Floats, runs: list[tuple[int, int]], count: int) -> Integers:
    kept = [end for run in runs for end in run]
    heap = [_farthest(rays, i, j) for i, j in runs]
    heapq.heapify(heap)
    while len(kept) < count and heap:
        gap, i, k, j = heapq.heappop(heap)
        if gap == 0.0:
            break
        kept.append(k)
        heapq.heappush(heap, _farthest(rays, i, k))
        heapq.heappush(heap, _farthest(rays, k, j))
    return np.sort(np.array(kept))


def _farthest(rays: Floats, i: int, j: int) -> tuple[float, int, int, int]:
    """Least-first heap entry: minus the distance of the point farthest off the chord, and the three indices."""
    if j - i < 2:
        return 0.0, i, i, j
    gaps = _off_chord(rays, i, j)
    k = int(np.argmax(gaps))
    return -float(gaps[k]), i, i + 1 + k, j


def _off_chord(rays: Floats, i: int, j: int) -> Floats:
    """Distance of the points strictly between i and j from the line through both."""
    along = rays[j] - rays[i]
    off = rays[i + 1 : j] - rays[i]
    return np.asarray(np.abs(along[0] * off[:, 1] - along[1] * off[:, 0]) / max(float(np.hypot(*along)), 1e-12))


def visvalingam(rays: Floats, joined: Booleans, count: int) -> Polylines:
    """Drop the point of the smallest triangle with its neighbours, until so many are left."""
    runs = longest_runs(joined, count)
    n = rays.shape[0]
    before, after = np.arange(n) - 1, np.arange(n) + 1
    area = np.full(n, np.nan)
    for i, j in runs:
        area[[i, j]] = np.inf
        area[i + 1 : j] = [_triangle(rays, k - 1, k, k + 1) for k in range(i + 1, j)]
    heap = [(float(area[k]), int(k)) for k in np.flatnonzero(np.isfinite(area))]
    heapq.heapify(heap)
    left, floor = int(np.sum(~np.isnan(area))), 0.0
    while left > count and heap:
        size, k = heapq.heappop(heap)
        if size != area[k]:
            continue
        floor = max(floor, size)
        area[k] = np.nan
        i, j = int(before[k]), int(after[k])
        after[i], before[j] = j, i
        left -= 1
        for m in (i, j):
            if np.isfinite(area[m]):
                area[m] = max(floor, _triangle(rays, int(before[m]), m, int(after[m])))
                heapq.heappush(heap, (float(area[m]), m))
    return _drawn(rays, np.flatnonzero(~np.isnan(area)), runs)


def _triangle(rays: Floats, i: int, k: int, j: int) -> float:
    (ax, ay), (bx, by) = rays[k] - rays[i], rays[j] - rays[i]
    return 0.5 * abs(float(ax * by - ay * bx))


def split_and_merge(rays: Floats, joined: Booleans, count: int) -> Polylines:
    """Split to twice as many vertices, then merge the neighbours that one line fits best, until so many are left."""
    runs = longest_runs(joined, count)
    kept = list(_split_farthest(rays, runs, 2 * count))
    ends = {end for run in runs for end in run}
    while len(kept) > count and len(kept) > len(ends):
        inner = [k for k in range(1, len(kept) - 1) if kept[k] not in ends]
        worst = [float(np.max(_off_chord(rays, kept[k - 1], kept[k + 1]))) for k in inner]
        del kept[inner[int(np.argmin(worst))]]
    return _drawn(rays, np.array(kept), runs)
