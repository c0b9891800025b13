"""Tracking by arcs: walls and edges heard again place a scan; the outline may guess, never against the wheels."""

from functools import cache

import numpy as np

from backend.factor_graph import FactorGraph, GraphSettings
from backend.odometry import Move, OdometrySettings
from backend.wheel_noise import driven
from frontend.local_map import Faces
from frontend.rigid_motion import between, compose
from frontend.scan import Floats
from slam.arc_tracking import ArcTracking, ArcTrackingSettings, Followed
from slam.perception import FrontendSettings, Percept, perceive
from slam.simulation.random_plans import random_plan
from slam.simulation.record import Recipe, drive_through
from slam.simulation.trajectory import in_first_frame, true_poses
from slam.simulation.world import build_world

NONE = [Faces(np.empty((0, 2)), np.empty((0, 2)))]
SURE = np.diag([1e-3, 1e-3, 1e-4]) ** 2


@cache
def simulated() -> tuple[list[Percept], Floats]:
    """Percepts of a sonar's first scans in a room, and their true poses (n, 3)."""
    world = build_world(random_plan(14, 6))
    assert world.drive is not None
    stood = true_poses(world.drive)[:6]
    scans = drive_through(world, stood, Recipe(seed=14))
    return [perceive(scan, FrontendSettings()) for scan in scans], in_first_frame(stood)


def started() -> tuple[ArcTracking, FactorGraph]:
    graph = FactorGraph(GraphSettings())
    graph.add_pose(0, np.zeros(3))
    graph.anchor(0, np.zeros(3), SURE)
    tracking, arcs = ArcTracking(ArcTrackingSettings()), simulated()[0][0].arcs
    assert arcs is not None
    tracking.start(graph, 0, arcs)
    return tracking, graph


def followed(move: Move, recent: list[Faces]) -> Followed:
    """Where the second scan is put after `move` (3,) from the first."""
    (tracking, graph), second = started(), simulated()[0][1]
    assert second.arcs is not None
    return tracking.follow(graph, second.arcs, second.surface, recent, move)


def claimed(error: Floats) -> Move:
    """Wheels that err by `error` (3,) on the way to the second scan."""
    return driven(compose(simulated()[1][1], error), OdometrySettings())


def faces_at(pose: Floats) -> list[Faces]:
    """Those of the first scan, believed to be at a pose (3,)."""
    return [Faces.placed(simulated()[0][0].surface, pose)]


def test_of_what_the_wheels_turn_wrongly_less_than_half_is_left_once_walls_are_heard_again() -> None:
    error = np.array([0.0, 0.0, 0.03])
    (left, covariance, recognised, _), (right, *_) = (followed(claimed(sign * error), NONE) for sign in (1, -1))
    assert recognised > 0
    assert abs(left[2] - right[2]) < 0.5 * 2 * error[2]
    assert covariance[2, 2] < claimed(error).covariance[2, 2]


def test_an_outline_that_contradicts_the_wheels_is_no_guess() -> None:
    move = claimed(np.zeros(3))
    alone, beside = followed(move, NONE), followed(move, faces_at(np.array([0.6, 0.6, 0.0])))
    np.testing.assert_array_equal(alone[0], beside[0])


def test_few_faces_are_no_guess() -> None:
    move, (faces,) = claimed(np.zeros(3)), faces_at(np.zeros(3))
    few = Faces(faces.points[:5], faces.normals[:5])
    np.testing.assert_array_equal(followed(move, NONE)[0], followed(move, [few])[0])


def test_edges_are_counted_once_for_every_scan_that_sees_them() -> None:
    (tracking, graph), (percepts, true) = started(), simulated()
    for number in range(1, len(percepts)):
        percept = percepts[number]
        assert percept.arcs is not None
        move = driven(between(true[number - 1], true[number]), OdometrySettings())
        tracking.follow(graph, percept.arcs, percept.surface, NONE, move)
    assert len(tracking.counts) == len(graph.landmarks) > 0
    seen = np.bincount([tie.landmark for tie in graph.landmark_ties], minlength=len(graph.landmarks))
    np.testing.assert_array_equal(tracking.counts, seen)
    assert np.all(tracking.counts >= 2)
