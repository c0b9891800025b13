from itertools import combinations
from typing import Any

import numpy as np
import pytest
from shapely import Polygon

from frontend.polyline import best_polyline, bounded_vertices, chord_costs
from tests.benchmarks.polylines import douglas_peucker, radial_errors, visvalingam
from tests.frontend.rooms import FURNISHED, L_ROOM, lidar_scan


def rays_of(room: Polygon, n: int = 90, seed: int = 0) -> Any:
    scan = lidar_scan(room, np.array([1.0, 1.5, 0.2]), n, seed=seed)
    return scan.ranges[:, None] * np.column_stack([np.cos(scan.bearings), np.sin(scan.bearings)])


def test_the_chosen_rays_are_the_best_there_are() -> None:
    rays = rays_of(FURNISHED, 18)
    costs = chord_costs(rays, np.inf)
    chains = [np.array([0, *middle, 17]) for middle in combinations(range(1, 17), 3)]
    best = min(np.sum(costs[chain[:-1], chain[1:]]) for chain in chains)
    slid = np.sum(radial_errors(rays, best_polyline(rays, 5)) ** 2)
    assert slid <= best + 1e-9


@pytest.mark.parametrize("count", [6, 10, 20])
@pytest.mark.parametrize("room", [L_ROOM, FURNISHED])
def test_no_other_choice_of_readings_comes_closer(room: Polygon, count: int) -> None:
    rays = rays_of(room)
    ours = np.sum(radial_errors(rays, best_polyline(rays, count)) ** 2)
    for other in (douglas_peucker, visvalingam):
        assert ours <= np.sum(radial_errors(rays, other(rays, count)) ** 2)


def test_every_reading_as_a_vertex_misses_nothing() -> None:
    rays = rays_of(L_ROOM, 30)
    assert np.allclose(best_polyline(rays, 30), rays)


@pytest.mark.parametrize("tolerance", [0.02, 0.05, 0.2])
def test_geometry_knots_keep_every_reading_within_the_tolerance(tolerance: float) -> None:
    rays = rays_of(L_ROOM)
    kept = bounded_vertices(rays, np.ones(90, dtype=bool), np.zeros(2), tolerance)
    chosen = rays[np.union1d(kept, [0, 89])]
    assert np.max(np.abs(radial_errors(rays, chosen))) <= tolerance + 1e-9
    assert chosen.shape[0] < 90
