"""The estimate: solved and refined without touching the graph, and whatever is doubted or left out is told."""

import numpy as np

from backend.estimate import Estimate
from frontend.rigid_motion import between, compose
from frontend.scan import Booleans, Floats
from slam.estimating import estimated
from slam.keyframes import Keyframe
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings, perceive
from slam.pose_graph import PoseGraph
from slam.simulation.trajectory import in_first_frame
from slam.wheels import Wheels
from tests.simulated_drives import drive, once_round, round_building

SETTINGS = MapperSettings()
STOOD = once_round()[:6]
TRUE = in_first_frame(STOOD)
PERCEPTS = [perceive(scan, FrontendSettings()) for scan in drive(round_building(), STOOD, seed=3)]
ALL = np.ones(len(TRUE), np.bool_)
SURE, DOUBTFUL = np.diag([0.001, 0.001, 0.001]) ** 2, np.diag([0.03, 0.03, 0.01]) ** 2


class Drive:
    """The scans of PERCEPTS in a graph, every second one a keyframe, each off by `error` (3,) from the one before."""

    def __init__(self, error: Floats, session_at: int | None = None) -> None:
        self.graph, self.wheels = PoseGraph(SETTINGS), Wheels(SETTINGS.odometry)
        self.wheels.begin_session(0)
        self.graph.begin_session(0, PERCEPTS[0])
        for scan in range(1, len(TRUE)):
            self._add(scan, compose(between(TRUE[scan - 1], TRUE[scan]), error), scan == session_at)

    def _add(self, scan: int, step: Floats, begins: bool) -> None:
        graph = self.graph
        if begins:
            graph.begin_session(scan, PERCEPTS[scan])
            self.wheels.begin_session(graph.sessions.newest)
            return
        pose = compose(graph.last_pose, step)
        if scan % 2:
            graph.add_beside(pose)
            return
        old, new = graph.keyframes[-1], len(graph.keyframes)
        graph.factors.add_pose(new, pose)
        graph.factors.add_motion(new - 1, new, between(old.pose, pose), DOUBTFUL)
        graph.add_keyframe(Keyframe(scan, old.session, PERCEPTS[scan], pose))
        graph.see_landmarks()

    def estimate(self, fitting: Booleans = ALL) -> Estimate:
        return estimated(self.graph, self.wheels, PERCEPTS, fitting, SETTINGS)


OFF = np.array([0.008, -0.008, 0.003])


def test_nothing_seen_gives_an_empty_estimate() -> None:
    found = estimated(PoseGraph(SETTINGS), Wheels(SETTINGS.odometry), [], np.empty(0, np.bool_), SETTINGS)
    assert (found.poses.shape, found.covariances.shape, found.landmarks.shape) == ((0, 3), (0, 3, 3), (0, 2))
    assert not found.decisions


def test_scans_that_drifted_by_centimetres_come_back_to_the_walls() -> None:
    drifted = Drive(OFF)
    assert np.max(np.abs(drifted.graph.poses - TRUE)[:, :2]) > 0.03
    assert np.max(np.abs(drifted.estimate().poses - TRUE)[:, :2]) < 0.01


def test_asking_leaves_the_graph_as_it_is() -> None:
    asked = Drive(OFF)
    before = (asked.graph.poses.tobytes(), list(asked.graph.decisions), asked.graph.factors.poses.tobytes())
    first, again = asked.estimate(), asked.estimate()
    assert (asked.graph.poses.tobytes(), asked.graph.decisions, asked.graph.factors.poses.tobytes()) == before
    assert first.poses.tobytes() == again.poses.tobytes()


def test_a_scan_beside_a_keyframe_is_as_doubtful_as_that() -> None:
    found = Drive(np.zeros(3)).estimate()
    np.testing.assert_array_equal(found.keyframes, [0, 2, 4])
    np.testing.assert_array_equal(found.covariances[2], found.covariances[3])
    assert np.trace(found.covariances[4]) > np.trace(found.covariances[2])


def test_a_scan_that_fitted_nowhere_is_out_of_the_map_and_pulls_nobody() -> None:
    astray = Drive(np.zeros(3))
    keyframe, _ = astray.graph.relative[3]
    lost = np.array([0.3, 0.4, 0.5])
    astray.graph.relative[3] = (keyframe, lost)
    fitting = ALL.copy()
    fitting[3] = False
    found = astray.estimate(fitting)
    np.testing.assert_array_equal(found.mapped, fitting)
    assert np.max(np.abs(found.poses - TRUE)[fitting, :2]) < 0.01
    assert np.hypot(*(found.poses[3] - TRUE[3])[:2]) > 0.1


def test_a_session_that_was_never_joined_starts_where_it_started_is_left_out_and_told() -> None:
    found = Drive(np.zeros(3), session_at=4).estimate()
    np.testing.assert_array_equal(found.mapped, [True, True, True, True, False, False])
    np.testing.assert_allclose(found.poses[4], 0, atol=1e-3)
    np.testing.assert_allclose(found.poses[5], between(TRUE[4], TRUE[5]), atol=0.01)
    told = [one for one in found.decisions if one.what == "session"]
    assert [one.scans for one in told] == [(4, 5)]


def test_landmarks_stand_at_corners_that_were_seen_again_and_the_others_are_told() -> None:
    found = Drive(np.zeros(3)).estimate()
    least = SETTINGS.landmarks.proven
    assert len(found.landmarks) >= 3
    assert np.all(found.sightings >= least)
    told = [one for one in found.decisions if one.what == "landmark"]
    assert all(len(one.scans) < least and set(one.scans) <= {0, 2, 4} for one in told)


def test_a_loop_that_the_graph_contradicts_is_told_in_sigmas_and_one_that_agrees_is_not() -> None:
    right, wrong = Drive(np.zeros(3)), Drive(np.zeros(3))
    right.graph.tie(0, 2, TRUE[4], SURE)
    wrong.graph.tie(0, 2, TRUE[4] + [2.0, 0, 0], SURE)
    told = [[one for one in made.estimate().decisions if one.what == "loop"] for made in (right, wrong)]
    assert not told[0]
    assert [one.scans for one in told[1]] == [(0, 4)]
    assert "sigmas" in told[1][0].reason
    assert np.max(np.abs(wrong.estimate().poses - TRUE)[:, :2]) < 0.01
