import numpy as np

from frontend.agreement import agreement
from frontend.rigid_motion import between
from tests.frontend.rooms import FURNISHED, sketched

HERE, THERE = np.array([2.8, 1.2, 0.2]), np.array([3.3, 1.5, 0.6])


def test_the_true_pose_lays_walls_on_walls() -> None:
    support, against = agreement(sketched(FURNISHED, HERE), sketched(FURNISHED, THERE, 1), between(HERE, THERE), 0.12)
    assert support > 0.95
    assert against < 0.05


def test_a_wrong_pose_puts_walls_into_free_space() -> None:
    wrong = between(HERE, THERE) + np.array([0.8, 0.6, 0.5])
    support, against = agreement(sketched(FURNISHED, HERE), sketched(FURNISHED, THERE, 1), wrong, 0.12)
    assert support < 0.6
    assert against > 0.3


def test_both_directions_count_alike() -> None:
    a, b = sketched(FURNISHED, HERE), sketched(FURNISHED, THERE, 1)
    forth, back = agreement(a, b, between(HERE, THERE), 0.12), agreement(b, a, between(THERE, HERE), 0.12)
    assert np.allclose(forth, back, atol=0.02)
