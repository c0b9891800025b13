"""A trajectory: where the robot truly stood for each scan, and where its wheels made it believe it stood."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from frontend.rigid_motion import between, compose, wrap
from frontend.scan import Floats
from slam.simulation.world import Drive


@dataclass(frozen=True)
class WheelNoise:
    """How wheels err (Thrun, Burgard & Fox 2005, §5.4): each figure is one standard deviation.

    distance: metres per metre driven. turn: radians per radian turned. turn_per_metre: radians per metre driven.
    slip: chance per move that a wheel loses a part of it; slipped: the part it then loses.
    """

    distance: float = 0.05
    turn: float = 0.05
    turn_per_metre: float = 0.02
    slip: float = 0.0
    slipped: float = 0.2


def true_poses(drive: Drive) -> Floats:
    """Poses (p, 3) along a drive: at its waypoints, or every `step` metres facing ahead where it has a step."""
    if drive.step is None:
        points = drive.waypoints
        headings = _headings_ahead(points) if drive.headings is None else drive.headings
        return np.column_stack([points, headings])
    legs = np.diff(drive.waypoints, axis=0)
    lengths = np.linalg.norm(legs, axis=1)
    waypoints, legs, lengths = drive.waypoints[:-1][lengths > 0], legs[lengths > 0], lengths[lengths > 0]
    reached = np.concatenate([[0.0], np.cumsum(lengths)])
    along = np.linspace(0.0, reached[-1], max(2, round(reached[-1] / drive.step) + 1))
    leg = np.clip(np.searchsorted(reached, along, side="right") - 1, 0, len(legs) - 1)
    share = ((along - reached[leg]) / lengths[leg])[:, None]
    points = waypoints[leg] + share * legs[leg]
    return np.column_stack([points, np.arctan2(legs[leg, 1], legs[leg, 0])])


def _headings_ahead(points: Floats) -> Floats:
    steps = np.diff(points, axis=0)
    ahead = np.arctan2(steps[:, 1], steps[:, 0])
    return np.append(ahead, ahead[-1:] if ahead.size else [0.0])


def wheel_odometry(poses: Floats, noise: WheelNoise, rng: np.random.Generator) -> Floats:
    """Dead-reckoned poses (p, 3) of a robot that truly stood at poses (p, 3); the first is the origin."""
    believed = [np.zeros(3)]
    for here, there in pairwise(poses):
        believed.append(compose(believed[-1], _felt(between(here, there), noise, rng)))
    return np.array(believed)


def _felt(move: Floats, noise: WheelNoise, rng: np.random.Generator) -> Floats:
    """A move (3,) as the wheels report it: scaled along, bent by a heading error, turned too much or too little."""
    distance = float(np.hypot(move[0], move[1]))
    reported = 1 + noise.distance * rng.normal()
    if rng.random() < noise.slip:
        reported += noise.slipped  # the wheels turn, the robot does not follow
    bend = noise.turn_per_metre * distance * rng.normal()
    turn = move[2] * (1 + noise.turn * rng.normal()) + bend
    cosine, sine = np.cos(bend / 2), np.sin(bend / 2)
    x, y = reported * (cosine * move[0] - sine * move[1]), reported * (sine * move[0] + cosine * move[1])
    return np.array([x, y, float(wrap(turn))])


def in_first_frame(poses: Floats) -> Floats:
    """Poses (p, 3) as seen from the first of them."""
    return np.array([between(poses[0], pose) for pose in poses])
