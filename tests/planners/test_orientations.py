import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from planners.circular import joined
from planners.orientations import intersected, legal_along
from planners.robot import Robot
from tests.planners.random_worlds import random_robot, random_world


def polar_of(robot: Robot) -> np.ndarray:
    x, y = robot.corners.T
    return np.column_stack([np.hypot(x, y), np.arctan2(y, x)])


def test_a_rectangle_between_parallel_walls_may_tilt_by_the_arc_of_its_corners() -> None:
    walls = np.array([[-50.0, -5, 50, -5], [50, 5, -50, 5]])
    legal = joined(legal_along(polar_of(Robot.rectangle(20, 8)), 0.0, np.array([-1.0, 0, 1, 0]), walls, 0.0))
    tilt = np.arcsin(5 / np.hypot(10, 4)) - np.arctan2(4, 10)
    expected = np.array([[np.pi - tilt, np.pi + tilt], [2 * np.pi - tilt, 2 * np.pi + tilt]])
    assert np.allclose(legal[np.argsort(legal[:, 0])], expected)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000))
def test_a_legal_heading_is_free_all_along_its_piece(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, robot = random_world(rng), random_robot(rng)
    ends = world.edges.reshape(-1, 4).copy()
    for _ in range(20):
        begin = rng.uniform(0, 100, 2)
        piece = np.concatenate([begin, begin + rng.uniform(-3, 3, 2)])
        if not shapely.covers(world.free, shapely.linestrings(piece.reshape(2, 2))):
            continue
        for low, high in legal_along(polar_of(robot), robot.radius, piece, ends, world.grid):
            for heading in rng.uniform(low, high, 3):
                place = piece[:2] + rng.random() * (piece[2:] - piece[:2])
                assert shapely.distance(robot.at(np.append(place, heading)), world.free.boundary) > 0


def test_sets_of_headings_intersect() -> None:
    first, second = np.array([[0.0, 1.0], [5.0, 2 * np.pi]]), np.array([[0.5, 5.5]])
    assert np.allclose(intersected(first, second), [[0.5, 1.0], [5.0, 5.5]])
