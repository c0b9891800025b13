"""Rigid motions of the plane: a pose is x, y, heading in the frame its name says."""

import numpy as np

from frontend.scan import Floats


def wrap(angle: Floats) -> Floats:
    """Angles brought into (−π, π]."""
    return np.asarray(np.pi - np.mod(np.pi - np.asarray(angle), 2 * np.pi))


def rotation(heading: float) -> Floats:
    """The (2, 2) matrix that turns by `heading`."""
    cosine, sine = np.cos(heading), np.sin(heading)
    return np.array([[cosine, -sine], [sine, cosine]])


def transform(points: Floats, pose: Floats) -> Floats:
    """Points (n, 2) of the frame at `pose` (3,), expressed in the frame the pose is given in."""
    return points @ rotation(pose[2]).T + pose[:2]


def compose(first: Floats, second: Floats) -> Floats:
    """The pose reached by `second` (3,) when it starts from `first` (3,)."""
    x, y = rotation(first[2]) @ second[:2] + first[:2]
    return np.array([x, y, float(wrap(first[2] + second[2]))])


def inverse(pose: Floats) -> Floats:
    """The pose (3,) of the outer frame seen from `pose`."""
    x, y = -rotation(pose[2]).T @ pose[:2]
    return np.array([x, y, float(wrap(-pose[2]))])


def between(first: Floats, second: Floats) -> Floats:
    """`second` (3,) seen from `first` (3,): compose(first, between(first, second)) == second."""
    return compose(inverse(first), second)
