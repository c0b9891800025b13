"""The roadmap of a disc: round one block the way is two tangents and an arc, and walls that part it are told."""

import numpy as np
import pytest
import shapely
from shapely import box

from planners.visibility import QUARTER, eroded, parted, roadmap_of, shortest
from planners.world import World
from tests.planners.known_worlds import door

BLOCK = World.from_obstacles(box(0, 0, 100, 60), [box(40, 20, 60, 40)])
LEFT, RIGHT = np.array([15.0, 30.0]), np.array([85.0, 30.0])


def length(way: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(way[:, :2], axis=0), axis=1).sum())


@pytest.mark.parametrize("radius", [1.0, 5.0])
def test_the_way_round_a_block_is_as_long_as_the_tightened_string(radius: float) -> None:
    way = shortest(roadmap_of(BLOCK, radius), LEFT, RIGHT)
    assert way is not None
    hull = shapely.union_all([box(40, 20, 60, 40).buffer(radius, quad_segs=256), shapely.MultiPoint([LEFT, RIGHT])])
    string = hull.convex_hull.length / 2
    assert string <= length(way) < 1.003 * string


def test_a_straight_way_is_taken_where_nothing_stands_in_it() -> None:
    way = shortest(roadmap_of(door(9), 4.0), LEFT, RIGHT)
    assert way is not None
    assert length(way) == pytest.approx(70)


@pytest.mark.parametrize(("radius", "shut"), [(4.4, False), (4.6, True)])
def test_a_door_parts_the_discs_that_are_wider(radius: float, shut: bool) -> None:
    assert parted(door(9), radius, LEFT, RIGHT) is shut
    assert (shortest(roadmap_of(door(9), radius), LEFT, RIGHT) is None) is shut


def test_where_a_disc_may_be_is_as_far_from_walls_as_its_radius_but_for_the_chords() -> None:
    (left, right) = eroded(door(9).free, 5.0)
    for part in (left, right):
        assert 5 * np.cos(np.pi / 4 / QUARTER) <= part.distance(door(9).free.boundary) + 1e-6 <= 5 + 2e-6


@pytest.mark.parametrize("seed", range(8))
def test_no_place_with_room_enough_is_parted_from_itself(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angles = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    walls = rng.uniform(9.9, 10.1, 300)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    world = World.from_free_space(shapely.Polygon(walls))
    places = rng.uniform(-10, 10, (20_000, 2))
    places = places[shapely.contains_xy(world.free, *places.T)]
    room = shapely.distance(shapely.points(places), world.free.boundary)
    for radius in (1.0, 4.0):
        barely = places[(room > radius) & (room < 1.02 * radius)]
        assert len(barely) > 5
        assert not any(parted(world, radius, place, place) for place in barely[:40])
