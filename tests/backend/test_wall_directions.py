"""Claims about the directions of walls."""

from itertools import pairwise

import numpy as np
import pytest

from backend.samples import Samples
from backend.settling import SettleSettings, settle
from backend.wall_directions import wall_directions
from tests.backend.placed_samples import joined, wall_samples


def facing(degrees: list[float], weight: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    angle = np.radians(degrees)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1), np.full(len(degrees), weight)


def walls(view: int, turn: float, shift: float) -> Samples:
    """Two walls of a room of its own, five metres long, as view `view` puts them when it is turned by `turn`."""
    cosine, sine = np.cos(turn), np.sin(turn)
    corners = np.array([[0.0, 5.0], [0.0, 0.0], [5.0, 0.0]]) @ np.array([[cosine, sine], [-sine, cosine]])
    rng = np.random.default_rng(0)
    parts = [wall_samples(a + shift, b + shift, 1, 0.0, rng) for a, b in pairwise(corners)]
    both = joined(*parts)
    return Samples(both.points, both.normals, np.full(len(both.view), view), both.sigma, both.weight, both.sure)


def test_walls_at_right_angles_share_one_direction() -> None:
    assert np.degrees(wall_directions(*facing([20.0, 110.0, 200.0, 290.0]))) == pytest.approx([20.0], abs=0.2)


def test_a_wing_that_stands_askew_has_a_direction_of_its_own() -> None:
    assert np.degrees(wall_directions(*facing([3.0, 93.0, 38.0]))) == pytest.approx([3.0, 38.0], abs=0.2)


def test_round_walls_have_no_direction() -> None:
    assert len(wall_directions(*facing(np.linspace(0, 360, 3000).tolist()))) == 0


def test_views_that_share_no_wall_turn_along_with_each_other() -> None:
    turns = np.radians([0.6, -0.6])
    placed = joined(walls(0, turns[0], 0.0), walls(1, turns[1], 20.0))
    found = settle(placed, np.zeros((2, 3)), SettleSettings())
    assert abs((turns[0] + found[0, 2]) - (turns[1] + found[1, 2])) < 0.25 * abs(turns[0] - turns[1])


def test_a_lone_view_does_not_turn_to_the_axes() -> None:
    found = settle(walls(0, 0.3, 0.0), np.zeros((1, 3)), SettleSettings())
    np.testing.assert_allclose(found, 0.0, atol=1e-9)
