"""Walls that stand square to each other hold the heading; those that don't are left alone."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.factor_graph import FactorGraph, GraphSettings
from backend.square_walls import SquareSettings, SquareWalls, quarter_turns

NOISE = np.diag([0.01, 0.01, 0.01]) ** 2
ENOUGH = SquareSettings().sightings


def rooms(*headings: float, turn: float = 0.1) -> FactorGraph:
    """A wall seen from each of some poses in a row, heading so much in the axes of its pose. turn: what wheels err."""
    driven = np.diag([0.01, 0.01, turn]) ** 2
    graph = FactorGraph(GraphSettings())
    for k, heading in enumerate(headings):
        graph.add_pose(k, np.array([float(k), 0.0, 0.0]))
        if k:
            graph.add_motion(k - 1, k, np.array([1.0, 0.0, 0.0]), driven)
        frame = np.array([1.0, 0.5, heading])
        graph.add_wall(k, np.array([k + 1.0, 0.5, heading]))
        graph.add_wall_sighting(k, k, frame, NOISE)
    graph.anchor(0, np.zeros(3), np.eye(3) * 1e-10)
    return graph


def squared(graph: FactorGraph) -> FactorGraph:
    """The graph with every wall seen often enough, solved."""
    SquareWalls(SquareSettings()).see(graph, np.full(len(graph.walls), ENOUGH))
    graph.solve(1e-9)
    return graph


def test_a_heading_that_drifted_is_put_right_by_walls_at_quarter_turns() -> None:
    # The robot took 0.05 rad too little of a turn for none, so its walls seem to turn.
    graph = squared(rooms(0.0, np.pi / 2 - 0.05, -0.05, np.pi - 0.05))
    assert len(graph.directions) == 1
    assert graph.poses[1:, 2] == pytest.approx(0.05, abs=0.02)


def test_a_wall_askew_founds_a_direction_of_its_own_and_bends_nothing() -> None:
    graph = squared(rooms(0.0, 0.5, np.pi / 2, 0.5 + np.pi / 2))
    assert len(graph.directions) == 2
    assert np.abs(graph.poses[:, 2]).max() < 1e-6


def test_one_wall_a_little_askew_among_square_ones_loses_its_weight() -> None:
    graph = squared(rooms(0.0, 0.0, 0.2, 0.0, np.pi / 2, turn=0.01))
    assert len(graph.directions) == 1
    assert np.abs(graph.poses[:, 2]).max() < 0.02


def test_a_wall_seen_seldom_is_held_to_nothing() -> None:
    graph = rooms(0.0, 0.05)
    SquareWalls(SquareSettings()).see(graph, np.full(2, ENOUGH - 1))
    assert len(graph.directions) == 0


def test_each_wall_is_held_once() -> None:
    graph, square = rooms(0.0, 0.05), SquareWalls(SquareSettings())
    for _ in range(3):
        square.see(graph, np.full(2, ENOUGH))
    assert len(graph.directions) == 1


def test_after_forgetting_other_directions_hold() -> None:
    graph, square = rooms(0.0, 0.05), SquareWalls(SquareSettings())
    square.see(graph, np.array([ENOUGH, 0]))
    square.forget()
    square.see(graph, np.array([ENOUGH, ENOUGH]))
    assert len(graph.directions) == 2


def test_a_direction_goes_along_with_what_is_carried() -> None:
    graph = squared(rooms(0.0, np.pi / 2))
    graph.anchor(1, graph.poses[1], NOISE)
    graph.carry({k: np.array([-pose[1], pose[0], pose[2] + np.pi / 2]) for k, pose in enumerate(graph.poses)}, 1)
    assert graph.directions == pytest.approx([np.pi / 2], abs=1e-6)


@settings(deadline=None, max_examples=50)
@given(st.floats(-20, 20))
def test_quarter_turns_and_the_rest_are_the_angle(angle: float) -> None:
    turns, rest = quarter_turns(angle)
    assert turns * np.pi / 2 + rest == pytest.approx(angle, abs=1e-9)
    assert abs(rest) <= np.pi / 4 + 1e-9
