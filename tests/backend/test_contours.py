"""Laws of tracing masks and putting rings together."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import MultiPolygon, Polygon, box

from backend.contours import as_polygons, assemble, contours


@given(st.integers(0, 10_000), st.floats(0.2, 0.8))
@settings(deadline=None, max_examples=30)
def test_traced_rings_follow_every_side_between_inside_and_outside_once(seed: int, share: float) -> None:
    mask = np.zeros((14, 17), dtype=bool)
    mask[1:-1, 1:-1] = np.random.default_rng(seed).random((12, 15)) < share
    sides = sum(int(np.count_nonzero(mask != np.roll(mask, 1, axis=axis))) for axis in (0, 1))
    assert sum(len(ring) for ring in contours(mask)) == sides


def test_a_room_with_a_hole_and_an_island_in_it_comes_back() -> None:
    mask = np.zeros((60, 60), dtype=bool)
    mask[5:55, 5:55] = True
    mask[15:45, 15:45] = False
    mask[25:35, 25:35] = True
    free = assemble(contours(mask))
    truth = box(5, 5, 55, 55).difference(box(15, 15, 45, 45)).union(box(25, 25, 35, 35))
    assert free.symmetric_difference(truth).area < 0.01 * truth.area  # only corners are cut by half a cell
    assert len(free.geoms) == 2


def test_cells_that_touch_at_a_corner_stay_apart() -> None:
    mask = np.zeros((6, 6), dtype=bool)
    mask[1:3, 1:3] = mask[3:5, 3:5] = True
    assert len(assemble(contours(mask)).geoms) == 2


def test_an_empty_mask_has_no_rings() -> None:
    assert contours(np.zeros((5, 5), dtype=bool)) == []
    assert assemble([]).is_empty


def test_lines_and_points_are_left_out_of_polygons() -> None:
    mixed = shapely.GeometryCollection([Polygon(box(0, 0, 1, 1)), shapely.LineString([(0, 0), (5, 5)])])
    assert as_polygons(mixed).equals(MultiPolygon([box(0, 0, 1, 1)]))


def test_a_ring_that_crosses_itself_a_little_is_still_outer() -> None:
    ring = np.array(
        [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 4.0], [2.001, 3.999], [1.999, 3.999], [2.0, 4.001], [0.0, 4.0]]
    )
    for start in range(len(ring)):
        assert abs(assemble([np.roll(ring, start, axis=0)]).area - 16) < 0.01


def test_a_hole_that_sticks_out_of_its_ring_a_little_is_still_cut() -> None:
    outer = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    hole = np.array([[-0.001, 1.0], [0.5, 2.0], [3.0, 2.0], [3.0, 1.0]])
    for start in range(4):
        assert abs(assemble([outer, np.roll(hole, start, axis=0)]).area - (16 - Polygon(hole).area)) < 0.01
