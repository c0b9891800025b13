import numpy as np
from shapely import box

from frontend.rigid_motion import between
from frontend.wall_pose import pose_of_walls
from tests.frontend.rooms import FURNISHED, sketched

HERE, THERE = np.array([2.8, 1.2, 0.2]), np.array([3.3, 1.5, 0.6])
MOVE = between(HERE, THERE)


def test_walls_laid_on_walls_give_the_move_to_centimetres() -> None:
    fixed, moving = sketched(FURNISHED, HERE).lines, sketched(FURNISHED, THERE, 1).lines
    pose, _ = pose_of_walls(fixed, moving, MOVE + np.array([0.06, -0.05, 0.02]), 0.2, 0.03)
    assert np.allclose(between(MOVE, pose), 0.0, atol=0.01)


def test_a_corridor_leaves_the_pose_free_along_itself() -> None:
    corridor = sketched(box(-90, 0, 90, 2), np.array([0.0, 1.0, 0.3])).lines
    _, information = pose_of_walls(corridor, corridor, np.zeros(3), 0.12, 0.03)
    loose, firm = np.linalg.eigvalsh(information[:2, :2])
    assert loose < 1e-2 * firm


def test_the_covariance_is_no_smaller_than_the_error() -> None:
    errors = []
    for seed in range(20):
        fixed, moving = sketched(FURNISHED, HERE, seed).lines, sketched(FURNISHED, THERE, 50 + seed).lines
        pose, information = pose_of_walls(fixed, moving, MOVE, 0.12, 0.03)
        errors.append((pose - MOVE) @ information @ (pose - MOVE))
    assert np.mean(errors) < 3.0
