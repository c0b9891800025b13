"""The last global step of the mapper: what all scans saw and what the wheels said, made ready to be solved together."""

from collections.abc import Sequence

import numpy as np

from backend.face_cells import Sheaf
from backend.joint_refinement import Chain, RefinementSettings, refine
from backend.odometry import Move, Odometry
from frontend.rigid_motion import between
from frontend.scan import Floats
from slam.perception import Percept
from slam.tracking import turned

UNKNOWN = 1e6 * np.eye(3)  # covariance of a move that nobody measured


def refined(poses: Floats, percepts: Sequence[Percept], moves: Sequence[Move], settings: RefinementSettings) -> Floats:
    """Poses (n, 3) of scans after all their faces and the moves between them, n − 1, were solved together."""
    if len(poses) < 2:
        return poses
    surfaces = [percept.surface for percept in percepts]
    sheaf = Sheaf(
        np.concatenate([surface.points for surface in surfaces]),
        np.concatenate([surface.normals for surface in surfaces]),
        np.concatenate([surface.spread for surface in surfaces]),
        np.repeat(np.arange(len(poses)), [len(surface.points) for surface in surfaces]),
    )
    chain = Chain(np.array([move.pose for move in moves]), np.array([move.covariance for move in moves]))
    return refine(poses, sheaf, chain, settings)


def wheels_say(odometry: Odometry, old: Percept, new: Percept) -> Move:
    """What the wheels say of the way between two scans of one session, covariance in the axes of the new one."""
    move = odometry.predict(between(old.scan.odometry, new.scan.odometry))
    return Move(move.pose, turned(move.covariance, -move.pose[2]))
