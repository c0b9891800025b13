"""A drive through a room heard by arcs alone."""

import numpy as np

from backend.arc_association import Placement
from backend.arc_landmarks import ArcLandmarks, ArcLandmarkSettings
from backend.arcs import Arcs
from backend.factor_graph import FactorGraph, GraphSettings
from backend.odometry import OdometrySettings
from backend.wheel_noise import driven
from tests.backend.test_arcs import arcs_of

TRUE = np.array([[0.5 * k, 0.0, 0.0] for k in range(6)])
WALLS = [(4.0, 0.0), (3.0, np.pi / 2), (2.5, -np.pi / 2)]  # distance from the origin, heading


def heard(pose: np.ndarray) -> Arcs:
    rows = [(d - np.cos(h) * pose[0] - np.sin(h) * pose[1], h - pose[2], 0.02) for d, h in WALLS]
    return arcs_of(*rows)


def test_wheels_that_err_are_put_right_by_walls_heard_again() -> None:
    graph, landmarks = FactorGraph(GraphSettings()), ArcLandmarks(ArcLandmarkSettings())
    graph.add_pose(0, np.zeros(3))
    graph.anchor(0, np.zeros(3), np.eye(3) * 1e-8)
    landmarks.see(graph, 0, heard(TRUE[0]), Placement(np.zeros(3), np.zeros((3, 3)), (), (0, 1, 2)), [])
    wrong = np.array([0.53, 0.0, 0.015])
    for k in range(1, len(TRUE)):
        move, arcs = driven(wrong, OdometrySettings()), heard(TRUE[k])
        placement, near = landmarks.place(graph, k - 1, move, arcs)
        assert len(placement.pairs) == len(WALLS)
        graph.add_pose(k, placement.pose)
        graph.add_motion(k - 1, k, move.pose, move.covariance)
        landmarks.see(graph, k, arcs, placement, near)
        graph.solve()
    assert len(graph.walls) == len(WALLS)
    assert np.abs(graph.poses - TRUE).max() < 0.02


def test_what_was_forgotten_is_not_recognised() -> None:
    graph, landmarks = FactorGraph(GraphSettings()), ArcLandmarks(ArcLandmarkSettings())
    graph.add_pose(0, np.zeros(3))
    graph.anchor(0, np.zeros(3), np.eye(3) * 1e-8)
    landmarks.see(graph, 0, heard(TRUE[0]), Placement(np.zeros(3), np.zeros((3, 3)), (), (0, 1, 2)), [])
    landmarks.forget()
    placement, _ = landmarks.place(graph, 0, driven(np.zeros(3), OdometrySettings()), heard(TRUE[0]))
    assert placement.loose == (0, 1, 2)


def test_walls_born_again_are_those_of_before() -> None:
    graph, landmarks = FactorGraph(GraphSettings()), ArcLandmarks(ArcLandmarkSettings())
    graph.add_pose(0, np.zeros(3))
    graph.anchor(0, np.zeros(3), np.eye(3) * 1e-8)
    landmarks.see(graph, 0, heard(TRUE[0]), Placement(np.zeros(3), np.zeros((3, 3)), (), (0, 1, 2)), [])
    move = driven(np.array([0.53, 0.0, 0.02]), OdometrySettings())
    graph.add_pose(1, move.pose)
    graph.add_motion(0, 1, move.pose, move.covariance)
    landmarks.see(graph, 1, heard(TRUE[1]), Placement(move.pose, move.covariance, (), (0, 1, 2)), [])
    graph.solve()
    assert len(graph.walls) == 2 * len(WALLS)
    reunion = landmarks.unite(graph, 1)
    assert reunion is not None
    assert reunion.united
    assert reunion.poses == (0, 1)
    assert reunion.reason.startswith("like those of before (walls: 3, edges: 0), evidence")
    graph.solve()
    assert landmarks.unite(graph, 1) is None
    assert np.abs(graph.poses[1] - TRUE[1]).max() < 0.01
    placement, near = landmarks.place(graph, 1, driven(np.array([0.5, 0.0, 0.0]), OdometrySettings()), heard(TRUE[2]))
    assert sorted(near[which] for _, which in placement.pairs) == [0, 1, 2]
