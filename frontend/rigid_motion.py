"""Rigid motions of the plane: a pose is x, y, heading in the frame its name says."""

from math import cos, pi, sin

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
    x, y, heading = map(float, first)
    forward, left, turn = map(float, second)
    cosine, sine = cos(heading), sin(heading)
    turned = pi - (pi - heading - turn) % (2 * pi)
    return np.array([x + cosine * forward - sine * left, y + sine * forward + cosine * left, turned])


def inverse(pose: Floats) -> Floats:
    """The pose (3,) of the outer frame seen from `pose`."""
    x, y, heading = map(float, pose)
    cosine, sine = cos(heading), sin(heading)
    return np.array([-cosine * x - sine * y, sine * x - cosine * y, pi - (pi + heading) % (2 * pi)])


def between(first: Floats, second: Floats) -> Floats:
    """`second` (3,) seen from `first` (3,): compose(first, between(first, second)) == second."""
    return compose(inverse(first), second)
