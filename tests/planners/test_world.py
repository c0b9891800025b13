import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import MultiPolygon, Polygon, box

from planners.world import World, WorldError
from tests.planners.random_worlds import random_obstacles, random_world

SEEDS = st.integers(0, 10_000)


@settings(deadline=None, max_examples=25)
@given(SEEDS)
def test_free_space_never_overlaps_what_was_given(seed: int) -> None:
    rng = np.random.default_rng(seed)
    obstacles = [shapely.make_valid(each) for each in random_obstacles(rng)]
    world = World.from_obstacles(box(0, 0, 100, 100), random_obstacles(np.random.default_rng(seed)))
    for obstacle in obstacles:
        assert world.free.distance(obstacle) > 0


@settings(deadline=None, max_examples=15)
@given(SEEDS)
def test_normals_point_from_the_obstacle_into_free_space(seed: int) -> None:
    world = random_world(np.random.default_rng(seed))
    lengths = np.linalg.norm(world.edges[:, 1] - world.edges[:, 0], axis=1)
    long = lengths > 1e-3
    beside = world.edges.mean(axis=1) + 2e-6 * world.normals
    assert shapely.contains_xy(world.free, beside[long]).mean() > 0.99
    assert np.allclose(np.einsum("ij,ij->i", world.edges[:, 1], world.normals), world.offsets, atol=1e-6)


def test_a_chain_of_thin_rectangles_becomes_one_wall() -> None:
    links = [box(10 + 9.5 * k, 50, 20 + 9.5 * k, 51) for k in range(6)]
    world = World.from_obstacles(box(0, 0, 100, 100), links)
    assert len(world.edges) == 8


def test_a_gap_that_is_only_rounding_is_closed() -> None:
    halves = [box(0, 40, 50, 60), box(50 + 1e-9, 40, 100, 60)]
    assert len(World.from_obstacles(box(0, 0, 100, 100), halves).free.geoms) == 2


def test_a_needle_without_area_still_stands_in_the_way() -> None:
    world = World.from_obstacles(box(0, 0, 10, 10), [Polygon([(0, 5), (10, 5), (5, 5)])])
    assert len(world.free.geoms) == 2


def test_an_obstacle_that_crosses_itself_keeps_both_lobes() -> None:
    bow = Polygon([(2, 2), (8, 8), (8, 2), (2, 8)])
    world = World.from_obstacles(box(0, 0, 10, 10), [bow])
    assert not shapely.contains_xy(world.free, [3.0, 7.0], [5.0, 5.0]).any()


def test_the_complement_of_free_space_is_obstacle() -> None:
    free = MultiPolygon([box(0, 0, 4, 3), box(6, 0, 9, 3)])
    world = World.from_free_space(free)
    assert world.free.symmetric_difference(free).area < 1e-5
    assert free.contains(world.free)


def test_a_wall_known_badly_keeps_farther_away_than_one_known_well() -> None:
    world = World.from_free_space(box(0, 0, 10, 10))
    walls = np.array([[[0, 0], [10, 0]], [[0, 10], [10, 10]]], dtype=float)
    kept = world.keep_away(walls, np.array([1.0, 0.1]))
    _, bottom, _, top = kept.bounds
    assert 1.0 <= bottom < 1.02
    assert 0.1 <= 10 - top < 0.102


@given(st.floats(0, 2 * np.pi), st.floats(0.05, 2.0), st.floats(0.1, 5.0))
@settings(max_examples=25, deadline=None)
def test_around_the_ends_of_a_wall_it_is_a_few_percent_farther_and_never_nearer(
    angle: float, clearance: float, length: float
) -> None:
    wall = np.array([[0, 0], [length * np.cos(angle), length * np.sin(angle)]])
    world = World.from_free_space(box(-20, -20, 20, 20)).keep_away(wall[None], np.array([clearance]))
    edge, line = world.free.geoms[0].interiors[0], shapely.linestrings(wall)
    assert shapely.distance(line, edge) >= clearance
    assert shapely.distance(line, shapely.points(edge.coords)).max() < 1.083 * clearance + 1e-5


def test_a_world_without_free_space_is_refused() -> None:
    with pytest.raises(WorldError, match="no free space"):
        World.from_obstacles(box(0, 0, 1, 1), [box(-1, -1, 2, 2)])
    with pytest.raises(WorldError, match="empty"):
        World.from_free_space(Polygon())
