"""The pose graph: scans go along with their keyframes, keyframes with what the factors say, sessions stay apart."""

import numpy as np

from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from frontend.scan import Floats
from slam.keyframes import Keyframe
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings, perceive
from slam.pose_graph import PoseGraph
from tests.simulated_drives import drive, once_round, round_building

TRUE = once_round()[:5]
PERCEPTS = [perceive(scan, FrontendSettings()) for scan in drive(round_building(), TRUE, seed=0)]
SURE, DOUBTFUL = np.diag([0.001, 0.001, 0.001]) ** 2, np.diag([0.1, 0.1, 0.05]) ** 2
STEP = np.array([1.0, 0.0, 0.0])


def go_on(graph: PoseGraph, step: Floats, covariance: Floats = DOUBTFUL) -> None:
    """Another keyframe of the newest session, `step` (3,) from the one before."""
    new, old = len(graph.keyframes), graph.keyframes[-1]
    pose = compose(old.pose, step)
    graph.factors.add_pose(new, pose)
    graph.factors.add_motion(new - 1, new, step, covariance)
    graph.add_keyframe(Keyframe(len(graph.relative), old.session, PERCEPTS[new % len(PERCEPTS)], pose))
    graph.drift.add(new - 1, new, covariance)


def driven(count: int, step: Floats = STEP) -> PoseGraph:
    graph = PoseGraph(MapperSettings())
    graph.begin_session(0, PERCEPTS[0])
    for _ in range(count - 1):
        go_on(graph, step)
    return graph


def after_sure_ones(count: int) -> PoseGraph:
    """So many doubtful steps after seven that are not."""
    graph = PoseGraph(MapperSettings())
    graph.begin_session(0, PERCEPTS[0])
    for number in range(7 + count):
        go_on(graph, STEP, SURE if number < 7 else DOUBTFUL)
    return graph


def found_at(pose: Floats) -> Alignment:
    """A firm alignment at a pose (3,)."""
    return Alignment(pose, np.asarray(np.linalg.inv(SURE)), np.empty((0, 2), np.int64), 0.01, 0.9, 0.8)


def test_a_loop_moves_the_newest_keyframe_whole_and_those_before_it_by_their_share() -> None:
    graph = after_sure_ones(4)
    graph.close(0, found_at(np.array([11.04, 0.0, 0.0])))
    graph.factors.solve()
    graph.settle()
    np.testing.assert_allclose(graph.keyframe_poses[7:, 0], [7, 8.01, 9.02, 10.03, 11.04], atol=1e-3)
    assert [keyframe.pose[0] for keyframe in graph.keyframes] == graph.keyframe_poses[:, 0].tolist()


def test_a_loop_lessens_the_doubt_of_the_place_it_was_closed_to() -> None:
    graph = after_sure_ones(7)
    before = graph.drift.place_from(14, graph.keyframe_poses[:, :2])[0]
    graph.close(0, found_at(graph.keyframe_poses[14]))
    assert graph.drift.place_from(14, graph.keyframe_poses[:, :2])[0] < 0.05 * before


def test_a_loop_is_no_surer_than_the_submap_it_was_found_on() -> None:
    sure, doubtful = after_sure_ones(4), driven(12)
    for graph in (sure, doubtful):
        graph.close(0, found_at(graph.keyframe_poses[-1]))
    firm, loose = (np.linalg.inv(graph.factors.ties[-1].information) for graph in (sure, doubtful))
    assert np.sqrt(firm[0, 0]) < 0.002
    assert np.sqrt(loose[0, 0]) > 0.1


def test_scans_beside_a_keyframe_go_along_where_it_is_moved() -> None:
    graph = driven(2)
    beside = compose(graph.keyframes[1].pose, np.array([0.1, 0.02, 0.05]))
    graph.add_beside(beside)
    np.testing.assert_allclose(graph.last_pose, beside, atol=1e-12)
    graph.close(0, found_at(np.array([1.5, 0.3, 0.4])))
    graph.factors.solve()
    graph.settle()
    np.testing.assert_allclose(between(graph.keyframes[1].pose, graph.last_pose), [0.1, 0.02, 0.05], atol=1e-12)
    np.testing.assert_allclose(graph.poses[2], graph.last_pose)


def test_what_was_not_settled_yet_is_where_it_was_put() -> None:
    graph = driven(3)
    graph.settle()
    go_on(graph, STEP)
    np.testing.assert_allclose(graph.keyframe_poses, [[x, 0, 0] for x in range(4)], atol=1e-9)


def test_every_session_is_told_from_its_own_start_and_knows_only_its_own_keyframes() -> None:
    graph = driven(3)
    graph.begin_session(3, PERCEPTS[0])
    go_on(graph, STEP)
    np.testing.assert_allclose(graph.poses[:, 0], [0, 1, 2, 0, 1], atol=1e-9)
    assert [keyframe.scan for keyframe in graph.last(4)] == [3, 4]


def test_forgotten_scans_stand_nowhere_and_keyframes_stay() -> None:
    graph = driven(2)
    graph.add_beside(np.array([1.1, 0, 0]))
    graph.add_beside(np.array([1.2, 0, 0]))
    graph.forget(2)
    assert len(graph.poses) == len(graph.keyframes) == 2


def test_a_corner_ties_poses_only_once_it_was_seen_again() -> None:
    graph = PoseGraph(MapperSettings())
    graph.begin_session(0, PERCEPTS[0])
    graph.see_landmarks()
    assert not graph.factors.landmark_ties
    for number in range(1, len(TRUE)):
        go_on(graph, between(TRUE[number - 1], TRUE[number]), SURE)
        graph.see_landmarks()
    tied = [tie.landmark for tie in graph.factors.landmark_ties]
    assert len(tied) >= 4
    assert min(np.bincount(tied)) >= MapperSettings().landmarks.proven


def test_decisions_are_kept_in_their_order_with_their_reasons() -> None:
    graph = driven(1)
    graph.refuse("loop", (0, 3), "too far")
    graph.accept("place", (1, 2), "seen twice")
    told = [(one.what, one.scans, one.accepted, one.reason) for one in graph.decisions]
    assert told == [("loop", (0, 3), False, "too far"), ("place", (1, 2), True, "seen twice")]
