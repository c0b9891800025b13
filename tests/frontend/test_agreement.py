import numpy as np
import pytest
from shapely import box

from frontend.agreement import agreement, near_wall
from frontend.rigid_motion import between
from tests.frontend.rooms import FURNISHED, sketched

HERE, THERE = np.array([2.8, 1.2, 0.2]), np.array([3.3, 1.5, 0.6])
WRONG = between(HERE, THERE) + np.array([0.8, 0.6, 0.5])


def test_the_true_pose_lays_walls_on_walls_and_a_wrong_one_puts_them_into_free_space() -> None:
    poses = np.array([between(HERE, THERE), WRONG])
    judged = agreement(sketched(FURNISHED, HERE), sketched(FURNISHED, THERE, 1), poses, 0.12)
    assert judged.support[0] > 0.95
    assert judged.support[1] < 0.6
    assert judged.against[1] > judged.laid[1] / 3


def test_both_directions_count_alike() -> None:
    a, b = sketched(FURNISHED, HERE), sketched(FURNISHED, THERE, 1)
    forth = agreement(a, b, between(HERE, THERE)[None], 0.12)
    back = agreement(b, a, between(THERE, HERE)[None], 0.12)
    assert forth.laid == pytest.approx(back.laid, rel=0.02)
    assert forth.against == pytest.approx(back.against, abs=0.1)


def test_walls_of_a_corridor_do_not_keep_it_from_sliding() -> None:
    corridor = sketched(box(-20, 0, 20, 2), np.array([0.0, 1.0, 0.0]))
    room = sketched(box(0, 0, 5, 4), np.array([2.0, 1.0, 0.0]))
    loose, firm = (agreement(view, view, np.zeros((1, 3)), 0.12) for view in (corridor, room))
    assert loose.fixing[0] < 0.15 * loose.laid[0]
    assert firm.fixing[0] > 3.0


def test_the_other_face_of_a_wall_is_another_wall() -> None:
    wall = np.array([[[0.0, 0.0], [2.0, 0.0]]])
    assert near_wall(wall, 1.0, 0.05, 1.0, 0.0, 0.12)
    assert not near_wall(wall, 1.0, 0.05, -1.0, 0.0, 0.12)
