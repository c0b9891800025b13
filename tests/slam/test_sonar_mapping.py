"""Mapping with a wide beam: a sonar that drives through a simulated room is placed by arcs, not by its wheels."""

from dataclasses import replace
from functools import cache

import numpy as np

from frontend.rigid_motion import between
from frontend.scan import Floats, Scan
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings, perceive
from slam.pose_graph import PoseGraph
from slam.scores.trajectories import absolute_errors
from slam.simulation.random_plans import random_plan
from slam.simulation.record import Recipe, drive_through
from slam.simulation.trajectory import in_first_frame, true_poses
from slam.simulation.world import build_world
from slam.sonar_mapping import SonarMapping

COUNT = 25


@cache
def simulated() -> tuple[list[Scan], Floats]:
    """Scans, and their true poses (n, 3)."""
    world = build_world(random_plan(14, 6))
    assert world.drive is not None
    stood = true_poses(world.drive)[:COUNT]
    return drive_through(world, stood, Recipe(seed=14)), in_first_frame(stood)


def mapped(scans: list[Scan]) -> PoseGraph:
    graph = PoseGraph(MapperSettings())
    sonar = SonarMapping(MapperSettings(), graph)
    percepts = [perceive(scan, FrontendSettings()) for scan in scans]
    graph.begin_session(0, percepts[0])
    sonar.begin_session(percepts[0])
    for number, percept in enumerate(percepts[1:], start=1):
        pose = sonar.follow(number, percept)
        np.testing.assert_array_equal(pose, graph.keyframes[-1].pose)
    return graph


def rmse(estimated: Floats, true: Floats) -> float:
    return float(np.sqrt(np.mean(absolute_errors(estimated[:, :2], true[:, :2]) ** 2)))


def test_arcs_place_a_sonar_better_than_its_wheels_do() -> None:
    scans, true = simulated()
    graph = mapped(scans)
    assert rmse(graph.poses, true) < 0.1
    assert rmse(graph.poses, true) < 0.5 * rmse(np.array([scan.odometry for scan in scans]), true)
    assert len(graph.factors.landmarks) > 0
    assert len(graph.factors.walls) > 0


def test_every_scan_of_a_sonar_is_a_keyframe_where_the_factors_put_it() -> None:
    graph = mapped(simulated()[0][:4])
    assert [keyframe.scan for keyframe in graph.keyframes] == [0, 1, 2, 3]
    np.testing.assert_allclose(graph.keyframe_poses, graph.factors.poses)


def test_a_scan_without_an_echo_is_placed_by_the_wheels_and_told() -> None:
    scans = simulated()[0][:3]
    silent = replace(scans[2], ranges=np.full(scans[2].ranges.size, np.inf))
    graph = mapped([*scans[:2], silent])
    claimed = between(scans[1].odometry, scans[2].odometry)
    np.testing.assert_allclose(between(graph.poses[1], graph.poses[2]), claimed, atol=1e-6)
    assert [one.scans for one in graph.decisions] == [(2,)]
    assert "placed by the wheels" in graph.decisions[0].reason


def test_what_was_learnt_of_one_room_is_not_looked_for_in_the_next_session() -> None:
    scans, _ = simulated()
    graph = PoseGraph(MapperSettings())
    sonar = SonarMapping(MapperSettings(), graph)
    percepts = [perceive(scan, FrontendSettings()) for scan in scans[:4]]
    for first in (0, 2):
        graph.begin_session(first, percepts[first])
        sonar.begin_session(percepts[first])
        sonar.follow(first + 1, percepts[first + 1])
    apart = graph.keyframes[2].pose - graph.keyframes[0].pose
    np.testing.assert_allclose(apart, graph.sessions.start(1), atol=1e-3)
    assert np.hypot(*graph.poses[3][:2]) < 1


def test_what_looks_like_landmarks_of_before_is_told_with_its_reason() -> None:
    decided = [made for made in mapped(simulated()[0]).decisions if made.what == "double"]
    assert decided
    assert all("evidence" in made.reason and len(made.scans) >= 2 for made in decided)
    assert all(made.scans == tuple(sorted(set(made.scans))) for made in decided)
