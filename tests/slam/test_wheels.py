"""Wheels: what is learnt of them goes with the robot, and where they slipped they say nothing of the way."""

from dataclasses import replace

import numpy as np
import pytest

from backend.odometry import OdometrySettings
from frontend.rigid_motion import between
from frontend.scan import Floats
from slam.keyframes import Keyframe
from slam.perception import FrontendSettings, Percept, perceive
from slam.refining import UNKNOWN, wheels_say
from slam.tracking import Placed
from slam.wheels import Wheels
from tests.simulated_drives import drive, once_round, round_building

SCAN = drive(round_building(), once_round()[:1], seed=0)[0]
STEP = np.array([0.4, 0.0, 0.1])
SURE = np.diag([0.005, 0.005, 0.002]) ** 2


def percept_at(odometry: Floats) -> Percept:
    return perceive(replace(SCAN, odometry=odometry), FrontendSettings())


PERCEPTS = [percept_at(np.array([0.5 * k, 0.0, 0.0])) for k in range(4)]
POSES = np.array([[0.45 * k, 0.01 * k, 0.0] for k in range(4)])


def taught(wheels: Wheels, scale: float, moves: int = 40) -> Wheels:
    """Wheels that claimed `scale` times the way they went."""
    for _ in range(moves):
        claim = STEP * [scale, scale, 1.0]
        assert wheels.learn(claim, STEP, Placed(STEP, SURE, 0.9), 0.5) is None
    return wheels


def begun() -> Wheels:
    wheels = Wheels(OdometrySettings())
    wheels.begin_session(0)
    return wheels


def test_before_the_first_session_the_wheels_are_believed_as_they_are() -> None:
    assert list(Wheels(OdometrySettings()).calibration.values()) == [1, 1, 0, 0, 0]


def test_a_scale_is_learnt_from_registered_moves() -> None:
    assert taught(begun(), 1.08).calibration["metres per metre"] == pytest.approx(1 / 1.08, abs=0.01)


def test_the_same_robot_put_elsewhere_keeps_what_was_learnt_of_its_wheels() -> None:
    wheels = taught(begun(), 1.08)
    learnt = wheels.calibration
    wheels.begin_session(1)
    assert wheels.calibration == learnt


def test_of_another_robots_wheels_nothing_is_known() -> None:
    wheels = taught(begun(), 1.08)
    wheels.change_robot()
    wheels.begin_session(1)
    assert wheels.calibration == begun().calibration


def test_each_session_is_told_by_the_wheels_it_was_driven_with() -> None:
    wheels = taught(begun(), 1.08)
    wheels.change_robot()
    wheels.begin_session(1)
    first, second = (wheels.say(Keyframe(0, session, PERCEPTS[0], POSES[0]), PERCEPTS[1]) for session in (0, 1))
    assert first.pose[0] == pytest.approx(0.5 / 1.08, abs=0.01)
    assert second.pose[0] == pytest.approx(0.5)


def test_a_slip_is_told_in_metres_degrees_and_sigmas_and_teaches_nothing() -> None:
    wheels = taught(begun(), 1.0)
    before = wheels.calibration
    reason = wheels.learn(np.array([2.0, 0.0, 0.1]), STEP, Placed(STEP, SURE, 0.9), 0.5)
    assert reason is not None
    assert "claim 2.00 m and 5.7°" in reason
    assert "says 0.40 m and 5.7°" in reason
    assert wheels.calibration == before


def test_a_slip_lasts_until_the_next_session_begins() -> None:
    wheels = begun()
    wheels.slip(3)
    assert wheels.slipped
    wheels.begin_session(1)
    assert not wheels.slipped


def test_the_chain_holds_what_wheels_say_but_the_poses_where_they_slipped() -> None:
    wheels = begun()
    wheels.slip(2)
    first, second, third = wheels.chain(POSES, PERCEPTS, [0, 0, 0, 0], [0, 1, 2, 3])
    said = wheels_say(wheels.newest, PERCEPTS[0], PERCEPTS[1])
    np.testing.assert_allclose(first.pose, said.pose)
    np.testing.assert_allclose(second.pose, between(POSES[1], POSES[2]))
    np.testing.assert_allclose(third.pose, said.pose)


def test_between_sessions_the_chain_says_nothing() -> None:
    wheels = begun()
    wheels.begin_session(1)
    moves = wheels.chain(POSES, PERCEPTS, [0, 0, 1, 1], [0, 1, 2, 3])
    assert [move.covariance is UNKNOWN for move in moves] == [False, True, False]


def test_left_out_scans_are_bridged() -> None:
    wheels = begun()
    (move,) = wheels.chain(POSES, PERCEPTS, [0, 0, 0, 0], [0, 3])
    assert move.pose[0] == pytest.approx(1.5)
