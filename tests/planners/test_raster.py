"""The raster of walls: no wall within reach of a cell is missing from its list."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.raster import raster_of


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.floats(0, 10))
def test_every_wall_within_reach_of_a_point_is_listed_in_its_cell(seed: int, reach: float) -> None:
    rng = np.random.default_rng(seed)
    ends = rng.uniform(0, 100, (30, 4))
    raster = raster_of(ends, (0.0, 0.0, 100.0, 100.0), reach)
    walls = shapely.linestrings(ends.reshape(-1, 2, 2))
    for x, y in rng.uniform(0, 100, (20, 2)):
        column, row = int((x - raster.left) / raster.cell), int((y - raster.bottom) / raster.cell)
        first = raster.first[column, row]
        listed = set(raster.members[first : first + raster.counts[column, row]])
        near = np.flatnonzero(shapely.distance(walls, shapely.Point(x, y)) <= reach)
        assert set(near) <= listed


def test_a_cell_far_from_all_walls_lists_none() -> None:
    raster = raster_of(np.array([[0.0, 0.0, 1.0, 0.0]]), (0.0, 0.0, 100.0, 100.0), 0.0)
    assert raster.counts[-1, -1] == 0
