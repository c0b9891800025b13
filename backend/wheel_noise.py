"""What wheels are worth: a move errs along the way, by a bend of it, and by its turn.

The model is that of Thrun, Burgard & Fox 2005, §5.4.
"""

import numpy as np

from backend.arcs import Floats
from backend.odometry import Move, OdometrySettings


def driven(wheels: Floats, settings: OdometrySettings) -> Move:
    """The move (3,) that wheels claim, covariance (3, 3) in the axes it started from.

    A bend turns the robot and swings its way by half as much, so place and heading err together.
    """
    way = float(np.hypot(*wheels[:2]))
    along = settings.distance_noise * np.array([wheels[0], wheels[1], 0.0])
    bend = settings.turn_per_metre * way * np.array([-wheels[1] / 2, wheels[0] / 2, 1.0])
    turn = float(np.hypot(settings.turn_noise * wheels[2], settings.least_turn))
    floor = np.diag([settings.least_distance, settings.least_distance, turn]) ** 2
    return Move(wheels, np.outer(along, along) + np.outer(bend, bend) + floor)
