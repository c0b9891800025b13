"""Doubted loops: one waits, a second that says the same from elsewhere is believed with it, and the drive closes."""

from dataclasses import replace

import numpy as np
import pytest

from backend.loop_closure import LoopSettings
from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from frontend.scan import Floats
from slam.doubted_loops import DoubtedLoops
from slam.keyframes import Keyframe
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings, perceive
from slam.pose_graph import PoseGraph
from tests.simulated_drives import drive, once_round, round_building

PERCEPT = perceive(drive(round_building(), once_round()[:1], seed=0)[0], FrontendSettings())
DRIFT = np.diag([0.3, 0.3, 0.02]) ** 2
SURE = np.diag([0.01, 0.01, 0.005]) ** 2
OFF = np.array([8.0, 1.0, 0.0])  # by which the drive's end is believed to be elsewhere


def out_and_back() -> PoseGraph:
    """Forty metres out and as many back on the same way, and the end believed to be off."""
    graph = PoseGraph(MapperSettings())
    graph.begin_session(0, PERCEPT)
    for new in range(1, 80):
        true = np.array([new if new < 40 else 79.0 - new, 0.0, 0.0])
        pose = true + max(new - 30, 0) / 49 * OFF
        extended(graph, pose)
    return graph


def doubted(graph: PoseGraph) -> DoubtedLoops:
    return DoubtedLoops(graph, LoopSettings(), 0.05)


def extended(graph: PoseGraph, pose: Floats, session: int = 0) -> None:
    new, step = len(graph.keyframes), between(graph.keyframes[-1].pose, pose)
    graph.factors.add_pose(new, pose)
    graph.factors.add_motion(new - 1, new, step, DRIFT)
    graph.drift.add(new - 1, new, DRIFT)
    graph.add_keyframe(Keyframe(new, session, PERCEPT, pose))


def seen_from(graph: PoseGraph, fixed: int, ahead: float, lie: float = 0.0, firmness: float = 0.5) -> Alignment:
    """The newest keyframe truly stands `ahead` metres before the fixed one."""
    pose = compose(graph.keyframes[fixed].pose, np.array([ahead + lie, 0.0, 0.0]))
    return Alignment(pose, np.asarray(np.linalg.inv(SURE)), np.empty((0, 2), np.int64), 0.01, 0.95, firmness)


def test_a_lone_doubted_loop_waits_and_moves_nothing() -> None:
    graph = out_and_back()
    before = graph.keyframe_poses
    assert not doubted(graph).weigh(0, seen_from(graph, 0, 0.0), proposes=True)
    np.testing.assert_array_equal(graph.keyframe_poses, before)
    assert [(one.what, one.scans, one.accepted) for one in graph.decisions] == [("loop", (0, 79), False)]


@pytest.mark.parametrize("step", [-4.0, 4.0])
def test_two_from_different_places_that_agree_close_the_drive(step: float) -> None:
    graph = out_and_back()
    loops = doubted(graph)
    loops.weigh(5, seen_from(graph, 5, -5.0), proposes=True)
    extended(graph, compose(graph.keyframes[-1].pose, np.array([step, 0.0, 0.0])))
    assert loops.weigh(5, seen_from(graph, 5, step - 5.0), proposes=True)
    assert [(one.scans[1], one.accepted) for one in graph.decisions] == [(79, False), (79, True), (80, True)]
    np.testing.assert_allclose(graph.keyframe_poses[[79, 80], :2], np.array([[0.0, 0.0], [step, 0.0]]), atol=0.3)


def test_a_loop_that_was_believed_confirms_no_other() -> None:
    graph = out_and_back()
    loops = doubted(graph)
    for number, ahead in enumerate((-5.0, -1.0, 3.0)):
        assert loops.weigh(5, seen_from(graph, 5, ahead), proposes=True) is (number == 1)
        extended(graph, compose(graph.keyframes[-1].pose, np.array([4.0, 0.0, 0.0])))
    assert [tie[:2] for tie in graph.factors.loop_residuals()] == [(5, 79), (5, 80)]


def test_a_loop_of_another_drive_that_was_never_joined_confirms_none() -> None:
    graph = out_and_back()
    loops = doubted(graph)
    near = replace(seen_from(graph, 5, 0.0), pose_in_fixed=compose(graph.keyframes[-1].pose, np.array([0.3, 0, 0])))
    loops.weigh(5, near, proposes=True)
    first = len(graph.keyframes)
    graph.begin_session(first, PERCEPT)
    for _ in range(40):
        extended(graph, compose(graph.keyframes[-1].pose, np.array([1.0, 0.0, 0.0])), session=1)
    near = replace(near, pose_in_fixed=compose(graph.keyframes[-1].pose, np.array([0.3, 0, 0])))
    assert not loops.weigh(first + 5, near, proposes=True)


@pytest.mark.parametrize(("step", "lie"), [(1.0, 0.0), (5.0, 3.0)])
def test_a_second_one_from_the_same_place_or_that_says_something_else_confirms_nothing(step: float, lie: float) -> None:
    graph = out_and_back()
    loops = doubted(graph)
    loops.weigh(5, seen_from(graph, 5, -5.0), proposes=True)
    extended(graph, compose(graph.keyframes[-1].pose, np.array([step, 0.0, 0.0])))
    assert not loops.weigh(5, seen_from(graph, 5, step - 5.0, lie), proposes=True)
    assert not any(one.accepted for one in graph.decisions)


def test_what_was_found_in_too_small_a_window_confirms_but_never_waits() -> None:
    graph = out_and_back()
    loops = doubted(graph)
    loops.weigh(5, seen_from(graph, 5, -5.0), proposes=False)
    extended(graph, compose(graph.keyframes[-1].pose, np.array([4.0, 0.0, 0.0])))
    assert not loops.weigh(5, seen_from(graph, 5, -1.0), proposes=True)
    extended(graph, compose(graph.keyframes[-1].pose, np.array([4.0, 0.0, 0.0])))
    assert loops.weigh(5, seen_from(graph, 5, 3.0), proposes=False)


@pytest.mark.parametrize(("firmness", "believed"), [((0.01, 0.01), False), ((0.01, 0.5), True), ((0.5, 0.01), True)])
def test_of_two_in_a_corridor_one_must_be_held_along_it(firmness: tuple[float, float], believed: bool) -> None:
    graph = out_and_back()
    loops = doubted(graph)
    loops.weigh(5, seen_from(graph, 5, -5.0, firmness=firmness[0]), proposes=True)
    extended(graph, compose(graph.keyframes[-1].pose, np.array([4.0, 0.0, 0.0])))
    assert loops.weigh(5, seen_from(graph, 5, -1.0, firmness=firmness[1]), proposes=True) is believed
