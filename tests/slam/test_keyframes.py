"""Keyframes: faces follow the pose, and neighbours are of one session."""

import numpy as np

from slam.keyframes import Keyframe, around
from slam.perception import FrontendSettings, perceive
from tests.simulated_drives import drive, once_round, round_building

PERCEPT = perceive(drive(round_building(), once_round()[:1], seed=0)[0], FrontendSettings())


def test_faces_move_with_the_pose() -> None:
    keyframe = Keyframe(0, 0, PERCEPT, np.zeros(3))
    before = keyframe.faces
    assert keyframe.faces is before
    keyframe.pose = np.array([1.0, 2.0, 0.0])
    np.testing.assert_allclose(keyframe.faces.points, before.points + np.array([1.0, 2.0]))


def test_neighbours_of_another_session_are_none() -> None:
    keyframes = [Keyframe(k, session, PERCEPT, np.zeros(3)) for k, session in enumerate((0, 0, 1, 1, 1))]
    assert [keyframe.scan for keyframe in around(keyframes, 3, 3, 3)] == [2, 3, 4]
    assert [keyframe.scan for keyframe in around(keyframes, 1, 5)] == [0, 1]
