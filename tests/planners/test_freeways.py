import numpy as np
import pytest
import shapely
from shapely import Polygon, box

from planners.freeways import faces_of, facing_pairs, spines
from planners.world import World

Floats = np.ndarray[tuple[int, ...], np.dtype[np.float64]]


def jagged(depth: float, teeth: int) -> World:
    """A corridor of 20 x 4 whose upper wall is a saw of so many teeth."""
    x = np.linspace(20, 0, 2 * teeth + 1)
    y = 4 - depth * (np.arange(2 * teeth + 1) % 2)
    return World.from_free_space(Polygon([(0, 0), (20, 0), *zip(x, y, strict=True)]))


def runs_of(world: World, tolerance: float) -> Floats:
    faces, lines = faces_of(world, tolerance)
    return spines(facing_pairs(faces, lines), faces, lines, world.edges.reshape(-1, 4).copy(), 1.0, 0.2)


def test_two_walls_that_face_each_other_make_a_spine_in_their_middle() -> None:
    across = runs_of(World.from_free_space(box(0, 0, 20, 4)), 0.05)
    middle = across[np.abs(across[:, 1] - across[:, 3]) < 1e-3]
    assert middle[:, [1, 3]] == pytest.approx(2.0, abs=1e-5)


def test_a_saw_of_small_teeth_makes_no_more_cones_than_a_wall() -> None:
    assert len(runs_of(jagged(0.03, 60), 0.05)) == len(runs_of(jagged(0.0, 1), 0.05))
    assert len(faces_of(jagged(0.3, 60), 0.05)[0]) > 120, "teeth that a robot feels are kept"


def test_spines_are_cut_by_walls_that_no_face_shows() -> None:
    world = jagged(0.03, 60)
    runs = runs_of(world, 0.05)
    assert shapely.covers(world.free.buffer(1e-6), shapely.linestrings(runs[:, :4].reshape(-1, 2, 2))).all()


def test_faces_have_free_space_on_their_left() -> None:
    faces, lines = faces_of(jagged(0.3, 10), 0.05)
    middles = (faces[:, :2] + faces[:, 2:]) / 2
    assert np.einsum("ij,ij->i", middles, lines[:, :2]) == pytest.approx(lines[:, 2])
    beside = middles + 1e-3 * lines[:, :2]
    assert shapely.contains_xy(jagged(0.3, 10).free, *beside.T).all()
