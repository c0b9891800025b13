"""Sessions: islands until two recognitions agree, then one frame, whoever came first."""

import numpy as np
import pytest

from frontend.rigid_motion import between, compose
from frontend.scan import Floats
from slam.keyframes import Keyframe
from slam.perception import FrontendSettings, perceive
from slam.sessions import Recognition, Sessions
from tests.simulated_drives import drive, once_round, round_building

PERCEPT = perceive(drive(round_building(), once_round()[:1], seed=0)[0], FrontendSettings())
SURE = np.diag([0.01, 0.01, 0.005]) ** 2
TRUE = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0], [3.0, 1.0, 0.5], [4.0, 1.0, 0.5]])


def two_sessions() -> tuple[Sessions, list[Keyframe]]:
    """Three keyframes of a first session at their true poses, two of a second one on its island."""
    sessions = Sessions()
    keyframes: list[Keyframe] = []
    for number, pose in enumerate(TRUE):
        first = 3 * (number >= 3)
        start = sessions.begin() if number in {0, 3} else keyframes[first].pose
        placed = compose(start, between(TRUE[first], pose))
        keyframes.append(Keyframe(number, sessions.newest, PERCEPT, placed))
    return sessions, keyframes


def seen(fixed: int, moving: int, error: Floats | None = None) -> Recognition:
    pose = between(TRUE[fixed], TRUE[moving])
    return Recognition(fixed, moving, pose if error is None else compose(pose, error), SURE)


def test_every_session_starts_far_from_all_others_and_is_told_from_its_own_start() -> None:
    sessions, keyframes = two_sessions()
    assert np.linalg.norm(keyframes[3].pose[:2] - keyframes[0].pose[:2]) > 500
    np.testing.assert_allclose(sessions.told(keyframes[3].pose, 1), 0, atol=1e-12)
    assert sessions.apart
    assert sessions.others(1) == [0]


def test_one_recognition_is_remembered_and_a_second_that_agrees_confirms_it() -> None:
    sessions, keyframes = two_sessions()
    assert sessions.confirm(seen(1, 3), keyframes) is None
    earlier = sessions.confirm(seen(2, 4), keyframes)
    assert earlier is not None
    assert (earlier.fixed, earlier.moving) == (1, 3)


@pytest.mark.parametrize("error", [np.array([2.0, 0, 0]), np.array([0, 0, 0.5])])
def test_recognitions_that_contradict_each_other_confirm_nothing(error: Floats) -> None:
    sessions, keyframes = two_sessions()
    assert sessions.confirm(seen(1, 3, error), keyframes) is None
    assert sessions.confirm(seen(2, 4), keyframes) is None


def test_a_second_look_from_the_same_spot_confirms_nothing() -> None:
    sessions, keyframes = two_sessions()
    assert sessions.confirm(seen(1, 3), keyframes) is None
    assert sessions.confirm(seen(2, 3), keyframes) is None


@pytest.mark.parametrize("found", [seen(2, 4), Recognition(4, 2, between(TRUE[4], TRUE[2]), SURE)])
def test_joined_the_later_session_lies_where_it_truly_was_whichever_was_recognised(found: Recognition) -> None:
    sessions, keyframes = two_sessions()
    moved, carry = sessions.join(found, keyframes)
    assert moved == [3, 4]
    for number in moved:
        np.testing.assert_allclose(compose(carry, keyframes[number].pose), TRUE[number], atol=1e-9)
    assert not sessions.apart
    assert sessions.root(1) == 0
