"""Reference simplifications of one scan: Douglas–Peucker, Visvalingam, split and merge, maximum likelihood.

Each takes the ends of a scan's rays (n, 2) in order, the sensor at the origin, and the number of vertices to keep, and
returns the polyline (v, 2). They are the peers of the front end's benchmark and no part of the product.
"""

import heapq

import numpy as np
from scipy.optimize import least_squares

from frontend.compiled import compiled
from frontend.scan import Floats, Integers


def douglas_peucker(rays: Floats, count: int) -> Floats:
    """Keep splitting the chord whose farthest point lies farthest off, until there are so many vertices."""
    return rays[_split_farthest(rays, count)]


def _split_farthest(rays: Floats, count: int) -> Integers:
    kept = [0, rays.shape[0] - 1]
    heap = [_farthest(rays, 0, rays.shape[0] - 1)]
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


def visvalingam(rays: Floats, count: int) -> Floats:
    """Drop the point of the smallest triangle with its neighbours, until so many are left."""
    n = rays.shape[0]
    before, after = np.arange(n) - 1, np.arange(n) + 1
    area = np.full(n, np.inf)
    heap = []
    for k in range(1, n - 1):
        area[k] = _triangle(rays, k - 1, k, k + 1)
        heap.append((area[k], k))
    heapq.heapify(heap)
    left, floor = n, 0.0
    while left > count:
        size, k = heapq.heappop(heap)
        if size != area[k]:
            continue
        floor = max(floor, size)
        area[k] = np.nan
        i, j = before[k], after[k]
        after[i], before[j] = j, i
        left -= 1
        for m in (i, j):
            if 0 < m < n - 1:
                area[m] = max(floor, _triangle(rays, before[m], m, after[m]))
                heapq.heappush(heap, (area[m], m))
    return np.asarray(rays[~np.isnan(area)])


def _triangle(rays: Floats, i: int, k: int, j: int) -> float:
    (ax, ay), (bx, by) = rays[k] - rays[i], rays[j] - rays[i]
    return 0.5 * abs(float(ax * by - ay * bx))


def radial_errors(rays: Floats, polyline: Floats) -> Floats:
    """How much longer each ray (n,) is than the polyline (v, 2) says; both in the order of their bearings."""
    bearings, corners = _bearings(rays), _bearings(polyline)
    edge = np.clip(np.searchsorted(corners, bearings - 1e-12), 1, polyline.shape[0] - 1)
    start, along = polyline[edge - 1], polyline[edge] - polyline[edge - 1]
    across = np.cos(bearings) * along[:, 1] - np.sin(bearings) * along[:, 0]
    reach = (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / across
    return np.asarray(np.hypot(rays[:, 0], rays[:, 1]) - reach)


def _bearings(points: Floats) -> Floats:
    return np.unwrap(np.arctan2(points[:, 1], points[:, 0]))


def split_and_merge(rays: Floats, count: int) -> Floats:
    """Split to twice as many vertices, then merge the neighbours that one line fits best, until so many are left."""
    kept = list(_split_farthest(rays, min(2 * count, rays.shape[0])))
    while len(kept) > count:
        worst = [float(np.max(_off_chord(rays, kept[k - 1], kept[k + 1]))) for k in range(1, len(kept) - 1)]
        del kept[1 + int(np.argmin(worst))]
    return np.asarray(rays[kept])


def maximum_likelihood(rays: Floats, count: int) -> Floats:
    """Drop the reading that costs the least radial likelihood until so many are left, then move all vertices freely to
    the best likelihood (after Schaefer, Büscher, Luft & Burgard 2018, Gaussian along the ray)."""
    start = most_likely_readings(rays, count)

    def errors(flat: Floats) -> Floats:
        moved = flat.reshape(-1, 2)
        bearings = _bearings(moved)
        ordered = bool(np.all(np.diff(bearings) > 0)) and bearings[-1] - bearings[0] < 2 * np.pi
        return radial_errors(rays, moved) if ordered else np.full(rays.shape[0], 1e3)

    moved = least_squares(errors, start.ravel(), max_nfev=8, x_scale=0.1)
    return np.asarray(moved.x.reshape(-1, 2) if moved.cost < 0.5 * np.sum(errors(start.ravel()) ** 2) else start)


def most_likely_readings(rays: Floats, count: int) -> Floats:
    """The readings that the greedy step of the maximum likelihood leaves, before they are moved."""
    n = rays.shape[0]
    before, after = np.arange(n) - 1, np.arange(n) + 1
    loss = np.full(n, np.inf)
    heap = []
    for k in range(1, n - 1):
        loss[k] = chord_error(rays, k - 1, k + 1)
        heap.append((float(loss[k]), k))
    heapq.heapify(heap)
    left = n
    while left > count:
        cost, k = heapq.heappop(heap)
        if cost != loss[k]:
            continue
        loss[k] = np.nan
        i, j = int(before[k]), int(after[k])
        after[i], before[j] = j, i
        left -= 1
        for m in (i, j):
            if 0 < m < n - 1:
                a, b = int(before[m]), int(after[m])
                loss[m] = chord_error(rays, a, b) - chord_error(rays, a, m) - chord_error(rays, m, b)
                heapq.heappush(heap, (float(loss[m]), m))
    return np.asarray(rays[~np.isnan(loss)])


@compiled
def chord_error(rays: Floats, i: int, j: int) -> float:
    """Squared radial error of the chord from ray i to ray j over the rays between."""
    dx, dy = rays[j, 0] - rays[i, 0], rays[j, 1] - rays[i, 1]
    total = 0.0
    for k in range(i + 1, j):
        length = np.hypot(rays[k, 0], rays[k, 1])
        miss = length * ((rays[i, 0] * dy - rays[i, 1] * dx) / (rays[k, 0] * dy - rays[k, 1] * dx) - 1.0)
        total += miss * miss
    return total
