import numpy as np
import pytest

from frontend.polyline import bounded_vertices
from tests.benchmarks.polylines import misses
from tests.frontend.rooms import L_ROOM, lidar_scan


@pytest.mark.parametrize("tolerance", [0.02, 0.05, 0.2])
def test_geometry_knots_keep_every_reading_within_the_tolerance(tolerance: float) -> None:
    scan = lidar_scan(L_ROOM, np.array([1.0, 1.5, 0.2]), 90, seed=0)
    rays = scan.ranges[:, None] * np.column_stack([np.cos(scan.bearings), np.sin(scan.bearings)])
    kept = bounded_vertices(rays, np.ones(90, dtype=bool), np.zeros(2), tolerance)
    chosen = rays[np.union1d(kept, [0, 89])]
    assert np.max(np.abs(misses(rays, chosen))) <= tolerance + 1e-9
    assert chosen.shape[0] < 90
