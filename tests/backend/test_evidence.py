"""Laws of the votes: exact areas, exact subtraction, no dependence on order."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from shapely import Polygon

from backend.evidence import TILE, Ballot, EvidenceGrid

NO_WALLS = np.empty((0, 2))


def star(seed: int, spread: float = 200.0) -> Ballot:
    """A random star-shaped ring in cells, anywhere around the origin, with a strip behind its first edges."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(-np.pi, np.pi, 24))
    radius = rng.uniform(20, 90, 24)[:, None]
    beams = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    ring = radius * beams + rng.uniform(-spread, spread, 2)
    strip = np.vstack([ring[:2], (ring + 3 * beams)[1::-1]])
    return Ballot(ring, strip)


def centres_inside(ring: NDArray[np.float64]) -> int:
    low, high = np.floor(ring.min(axis=0)), np.ceil(ring.max(axis=0))
    x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
    return int(shapely.contains_xy(Polygon(ring), x, y).sum())


@given(st.integers(0, 10_000))
@settings(deadline=None, max_examples=20)
def test_a_cell_is_voted_free_if_and_only_if_its_centre_is_inside(seed: int) -> None:
    ballot = star(seed)
    grid = EvidenceGrid(0.025)
    grid.cast(ballot, 1)
    assert grid.counts().free.sum() == centres_inside(ballot.free)
    assert grid.counts().free.max() == 1


@given(st.lists(st.integers(0, 10_000), min_size=2, max_size=6), st.randoms())
@settings(deadline=None, max_examples=10)
def test_votes_do_not_depend_on_order_and_can_be_taken_back(seeds: list[int], random: object) -> None:
    one, other = EvidenceGrid(0.025), EvidenceGrid(0.025)
    for seed in seeds:
        one.cast(star(seed), 1)
    for seed in [*reversed(seeds), 77]:
        other.cast(star(seed), 1)
    other.cast(star(77), -1)
    points = np.random.default_rng(0).uniform(-8, 8, (4000, 2))
    for a, b in zip(one.counts().at(points), other.counts().at(points), strict=True):
        np.testing.assert_array_equal(a, b)


def test_tiles_are_made_only_where_views_reach() -> None:
    grid = EvidenceGrid(0.025)
    for corner in (0.0, 40.0 * TILE):
        ring = corner + np.array([[1.0, 1.0], [50.0, 1.0], [50.0, 50.0], [1.0, 50.0]])
        grid.cast(Ballot(ring, NO_WALLS), 1)
    assert grid.bytes < 10 * TILE * TILE * 4 + 41 * 41 * 8


def test_points_beyond_the_map_have_no_votes() -> None:
    grid = EvidenceGrid(0.025)
    grid.cast(star(1), 1)
    free, wall = grid.counts().at(np.array([[1e3, -1e3]]))
    assert (int(free[0]), int(wall[0])) == (0, 0)
