"""Claims about ground that a view only bounds: an arc in a door, a silence."""

import numpy as np
import pytest
from numpy.typing import NDArray

from backend.evidence import Counts
from backend.far_ground import far_ground
from backend.samples import Samples

Floats = NDArray[np.float64]
CELL = 0.05
ORIGIN = np.array([3.0, 1.0])
DOOR = np.array([[[3.4, 2.0], [2.6, 2.0]]])
NOTHING = np.empty((0, 2, 2))


def wedge(depth: float) -> tuple[Floats, Floats]:
    """A view 1 m below a wall with a door, sure up to the wall and bounded to `depth` metres beyond it."""
    x = np.linspace(3.4, 2.6, 9)
    wall = np.array([[6.0, 0.0], [6.0, 2.0], [3.45, 2.0], *np.stack([x, np.full(9, 2.0)], axis=1), [2.55, 2.0], [0, 2]])
    near = np.vstack([wall, [[0.0, 0.0]]])
    far = near.copy()
    far[3:12] += depth * (near[3:12] - ORIGIN)
    return near, far


def votes(walls: list[tuple[float, float, float, float]]) -> Counts:
    """Counts of a field of 6 m with wall votes in boxes x0, y0, x1, y1."""
    wall = np.zeros((120, 120), dtype=np.int16)
    for x0, y0, x1, y1 in walls:
        wall[round(y0 / CELL) : round(y1 / CELL), round(x0 / CELL) : round(x1 / CELL)] = 1
    return Counts(np.zeros_like(wall), wall, np.zeros(2, dtype=np.int64), CELL)


def surface(points: list[tuple[float, float]], aside: float) -> tuple[Samples, Floats]:
    """Samples that face downwards, each of which may lie aside."""
    count = len(points)
    normals = np.tile([0.0, -1.0], (count, 1))
    placed = np.array(points).reshape(-1, 2)
    view, sigma = np.ones(count, dtype=np.int64), np.full(count, 0.01)
    return Samples(placed, normals, view, sigma, np.full(count, 0.1), np.ones(count, dtype=bool)), np.full(count, aside)


def depth_of(doors: Floats, others: tuple[Samples, Floats], counts: Counts) -> float:
    """How far beyond the wall the middle of the wedge is cleared, metres."""
    cleared = far_ground(ORIGIN, wedge(1.5), doors, others, counts)
    rows = np.flatnonzero(cleared[:, round(3.0 / CELL)])
    return float(rows.max() + 1) * CELL - 2.0


def test_a_bound_that_nobody_contradicts_is_cleared_to_its_end() -> None:
    assert depth_of(DOOR, surface([], 0.0), votes([])) == pytest.approx(1.5, abs=2 * CELL)


def test_what_another_view_measured_inside_ends_the_bound_there() -> None:
    across = [(x, 2.8) for x in np.linspace(2.0, 4.0, 41)]
    assert depth_of(DOOR, surface(across, 0.0), votes([])) == pytest.approx(0.8, abs=2 * CELL)


def test_a_wall_behind_the_door_stops_the_sight() -> None:
    assert depth_of(DOOR, surface([], 0.0), votes([(0, 3, 6, 3.1)])) == pytest.approx(1.0, abs=2 * CELL)


def test_the_smear_of_a_wide_beam_in_the_plane_of_the_door_does_not_close_it() -> None:
    smear = surface([(x, 2.0) for x in np.linspace(2.6, 3.4, 17)], 0.41)
    assert depth_of(DOOR, smear, votes([(2.6, 2.0, 3.4, 2.1)])) == pytest.approx(1.5, abs=2 * CELL)


def test_where_no_door_was_seen_the_same_readings_are_a_wall() -> None:
    smear = surface([(x, 2.0) for x in np.linspace(2.6, 3.4, 17)], 0.41)
    assert depth_of(NOTHING, smear, votes([(2.6, 2.0, 3.4, 2.1)])) == pytest.approx(0.0, abs=2 * CELL)
