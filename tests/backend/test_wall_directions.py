"""Claims about the directions of walls."""

from itertools import pairwise

import numpy as np
import pytest

from backend.samples import Samples
from backend.settling import SettleSettings, settle
from backend.wall_directions import DirectionSettings, angle_errors, wall_directions
from tests.backend.placed_samples import joined, wall_samples


def directions(degrees: list[float], known_to: float = 0.5) -> np.ndarray:
    """Directions of so many equal pieces of surface that face these ways; all in degrees."""
    angle = np.radians(degrees)
    normals, errors = np.stack([np.cos(angle), np.sin(angle)], axis=1), np.full(len(angle), np.radians(known_to))
    return np.degrees(wall_directions(normals, np.ones(len(angle)), errors, DirectionSettings().outstanding))


def walls(view: int, turn: float, shift: float) -> Samples:
    """Two walls of a room of its own, five metres long, as view `view` puts them when it is turned by `turn`."""
    cosine, sine = np.cos(turn), np.sin(turn)
    corners = np.array([[0.0, 5.0], [0.0, 0.0], [5.0, 0.0]]) @ np.array([[cosine, sine], [-sine, cosine]])
    rng = np.random.default_rng(0)
    parts = [wall_samples(a + shift, b + shift, 1, 0.0, rng) for a, b in pairwise(corners)]
    both = joined(*parts)
    return Samples(both.points, both.normals, np.full(len(both.view), view), both.sigma, both.weight, both.sure)


def test_walls_at_right_angles_share_one_direction() -> None:
    assert directions([20.0, 110.0, 200.0, 290.0]) == pytest.approx([20.0], abs=0.2)


def test_a_wing_that_stands_askew_has_a_direction_of_its_own() -> None:
    assert directions([3.0, 93.0, 38.0]) == pytest.approx([3.0, 38.0], abs=0.2)


def test_round_walls_have_no_direction() -> None:
    assert len(directions(np.linspace(0, 360, 3000).tolist())) == 0


def test_directions_are_told_apart_as_sharply_as_walls_are_known() -> None:
    assert directions([10.0] * 3 + [11.2] * 2, known_to=0.2) == pytest.approx([10.0, 11.2], abs=0.2)
    assert len(directions([10.0] * 3 + [11.2] * 2, known_to=1.0)) == 1


def test_the_longer_a_wall_is_the_better_its_angle_is_known() -> None:
    rng = np.random.default_rng(0)
    parts = [wall_samples(np.zeros(2), np.array([length, 0.0]), 1, 0.0, rng) for length in (1.0, 4.0)]
    parts[1] = Samples(
        parts[1].points, parts[1].normals, parts[1].view + 1, parts[1].sigma, parts[1].weight, parts[1].sure
    )
    errors, length = angle_errors(joined(*parts), 0.1)
    assert length[[0, -1]] == pytest.approx([1.0, 4.0])
    assert errors[0] / errors[-1] == pytest.approx(8.0)


@pytest.mark.parametrize("askew", [1.0, 2.0, 4.0])
def test_a_wing_a_degree_askew_is_not_bent_to_the_rest_of_the_building(askew: float) -> None:
    views = 8
    placed = [walls(view, np.radians(askew) * (view >= views), 20.0 * (view >= views)) for view in range(2 * views)]
    found = settle(joined(*placed), np.zeros((2 * views, 3)), SettleSettings())
    assert np.degrees(found[views:, 2].mean() - found[:views, 2].mean()) == pytest.approx(0.0, abs=0.04)


def test_views_that_share_no_wall_turn_along_with_each_other() -> None:
    turns = np.radians([0.6, -0.6])
    placed = joined(walls(0, turns[0], 0.0), walls(1, turns[1], 20.0))
    found = settle(placed, np.zeros((2, 3)), SettleSettings())
    assert abs((turns[0] + found[0, 2]) - (turns[1] + found[1, 2])) < 0.25 * abs(turns[0] - turns[1])


def test_a_lone_view_does_not_turn_to_the_axes() -> None:
    found = settle(walls(0, 0.3, 0.0), np.zeros((1, 3)), SettleSettings())
    np.testing.assert_allclose(found, 0.0, atol=1e-9)
