"""Odometry: the move the wheels claim, corrected by what earlier registrations taught about the wheels.

A Kalman filter (filterpy) keeps five constants of the robot, learnt from the log itself: how far it really goes per
metre claimed, how far it really turns per radian claimed, how much it turns unnoticed per metre, and where the point
that is being registered sits before and beside the centre of turning. A registered move that disagrees by more than
the gate is a slip (or a wrong registration): it teaches nothing and is reported.
"""

from collections import deque
from dataclasses import dataclass
from math import cos, hypot, sin
from statistics import median
from typing import NamedTuple

import numpy as np
from filterpy.kalman import KalmanFilter

from backend.arcs import Floats
from backend.steady_motion import SteadyMotion


@dataclass(frozen=True)
class OdometrySettings:
    """How far the wheels are trusted."""

    distance_noise: float = 0.05  # of the distance; larger trusts the wheels less
    turn_noise: float = 0.05  # of the turn
    turn_per_metre: float = 0.03  # radians of unnoticed turn per metre
    least_distance: float = 0.01  # metres of noise that even a standing robot has
    least_turn: float = 0.005  # radians
    scale_doubt: float = 0.1  # how wrong the scales may be before anything is learnt; larger learns faster
    bias_doubt: float = 0.1  # the same for the unnoticed turn, radians per metre
    mount_doubt: float = 0.1  # the same for the sensor's place on the robot, metres
    gap_seconds: float = 5.0  # without a scan that are a gap; larger believes the wheels over longer pauses
    gap_intervals: float = 10.0  # usual intervals that are a gap, if that is longer; larger does the same
    fastest: float = 5.0  # metres per second that wheels may claim; larger believes wilder claims
    lost_metres: float = 0.5  # doubt of a move that no wheels tell, before any was seen; larger trusts registration
    lost_radians: float = 0.3
    remembered: int = 30  # newest moves that say how far the next may go without wheels; larger forgets more slowly
    slips: int = 3  # in a row until the wheels are no longer asked; larger asks broken wheels longer
    slip_gate: float = 16.3  # squared Mahalanobis distance (χ², 3 degrees of freedom, 0.1 %); larger calls less a slip


@dataclass(frozen=True, eq=False)
class Move:
    """A relative pose (3,) = forward, left, turn with its covariance (3, 3)."""

    pose: Floats
    covariance: Floats


class _Compared(NamedTuple):
    """A registered move against the wheels' claim: squared Mahalanobis distance, residual (3,), and the
    covariance (3, 3) of both."""

    distance: float
    residual: Floats
    noise: Floats


class Odometry:
    """Predicts moves from wheel moves and learns the wheels' constants from registered ones."""

    def __init__(self, settings: OdometrySettings) -> None:
        self.settings = settings
        self._filter = KalmanFilter(dim_x=5, dim_z=3)
        self._filter.x = np.array([[1.0], [1.0], [0.0], [0.0], [0.0]])
        doubts = [settings.scale_doubt, settings.scale_doubt, settings.bias_doubt]
        self._filter.P = np.diag([*doubts, settings.mount_doubt, settings.mount_doubt]) ** 2
        self._intervals: deque[float] = deque(maxlen=100)
        self._slips = 0  # in a row
        self.proven = False  # whether they ever claimed a move that was seen
        self._steady = SteadyMotion((settings.lost_metres, settings.lost_radians), settings.remembered)

    @property
    def calibration(self) -> Floats:
        """(5,): metres per metre claimed, radians per radian claimed, radians per metre, mount forward and left."""
        return np.array(self._filter.x[:, 0])

    @property
    def calibration_spread(self) -> Floats:
        """(5,) standard deviations of the calibration."""
        return np.array(np.sqrt(np.diag(self._filter.P)))

    @property
    def broken(self) -> bool:
        """Whether the wheels were wrong so often in a row that they are not asked."""
        return self._slips >= self.settings.slips

    def predict(self, wheels: Floats) -> Move:
        """The move to expect when the wheels claim the relative pose `wheels` (3,)."""
        pose, jacobian = self._moved(wheels)
        return Move(pose, self._noise(wheels) + jacobian @ self._filter.P @ jacobian.T)

    def expect(self, wheels: Floats, seconds: float) -> tuple[Move, str | None]:
        """The move to expect in so many seconds, and why the wheels cannot be taken at their word, if so."""
        usual = median(self._intervals) if self._intervals else np.inf
        self._intervals.append(seconds)
        way, settings = float(np.hypot(wheels[0], wheels[1])), self.settings
        if way > settings.fastest * max(seconds, 0.0) + settings.lost_metres:
            return Move(np.zeros(3), self._lost), f"the wheels claim {way:.1f} m in {seconds:.2f} s"
        expected = self.steady(seconds) if self.broken else self.predict(wheels)
        if seconds > max(settings.gap_seconds, settings.gap_intervals * usual):
            doubted = Move(expected.pose, expected.covariance + self._lost)
            return doubted, f"{seconds:.1f} s without a scan, usually {usual:.2f} s"
        return expected, None

    def steady(self, seconds: float) -> Move:
        """The move to expect without wheels."""
        return Move(*self._steady.foretell(seconds))

    def lose(self) -> None:
        """The last move is not known: the next one begins nobody knows where."""
        self._steady.lose()

    def arrive(self) -> None:
        """The last scan stands where moves are told from again."""
        self._steady.arrive()

    def slide(self, wheels: Floats, registered: Move) -> None:
        """The last move is known but for how far it went, along a corridor: it teaches nothing.

        Wheels that were right before are asked again if they claim a move which it allows; one more slip ends that.
        """
        self._steady.slide()
        asked_again = self.broken and self.proven and self._claims_a_move(wheels)
        if asked_again and self._compared(wheels, registered).distance <= self.settings.slip_gate:
            self._slips = self.settings.slips - 1

    @property
    def _lost(self) -> Floats:
        return np.diag([self.settings.lost_metres, self.settings.lost_metres, self.settings.lost_radians]) ** 2

    def learn(self, wheels: Floats, registered: Move, seconds: float = 1.0) -> float:
        """Take in a registered move in so many seconds; the squared Mahalanobis distance from what the wheels claim.

        Over `slip_gate` it taught nothing of the wheels.
        """
        distance, residual, noise = self._compared(wheels, registered)
        self._steady.see(registered.pose, seconds)
        if distance > self.settings.slip_gate:
            self._slips += 1
            return distance
        if self._claims_a_move(wheels):
            self._slips, self.proven = 0, True
        # The constants act on what was claimed, noise and all. Learnt against that, a straight drive of noisy turns
        # would teach that turns mean nothing (regression dilution): they are learnt against the move that was made.
        _, made = self._moved(registered.pose)
        self._filter.update(residual[:, None] + made @ self._filter.x, R=noise, H=made)
        return distance

    def _claims_a_move(self, wheels: Floats) -> bool:
        """Only wheels that do, and rightly, work: those that are stuck are right about a standing robot."""
        settings = self.settings
        return bool(hypot(wheels[0], wheels[1]) > settings.least_distance or abs(wheels[2]) > settings.least_turn)

    def _compared(self, wheels: Floats, registered: Move) -> "_Compared":
        """How far a registered move is from what the wheels claim."""
        predicted, jacobian = self._moved(wheels)
        residual = registered.pose - predicted
        residual[2] = np.arctan2(np.sin(residual[2]), np.cos(residual[2]))
        noise = self._noise(wheels) + registered.covariance
        distance = float(residual @ np.linalg.solve(jacobian @ self._filter.P @ jacobian.T + noise, residual))
        return _Compared(distance, residual, noise)

    def _moved(self, wheels: Floats) -> tuple[Floats, Floats]:
        """The corrected move (3,) of the registered point and its derivative (3, 5) with respect to the constants."""
        scale, turn_scale, bias, before, beside = self._filter.x[:, 0].tolist()
        x, y, turned = wheels.tolist()
        way = hypot(x, y)
        turn = turn_scale * turned + bias * way
        # The turn that the wheels did not notice happens along the way: the chord swings by half of it.
        c, s = cos((turn - turned) / 2), sin((turn - turned) / 2)
        chord_x, chord_y = c * x - s * y, s * x + c * y
        c, s = cos(turn), sin(turn)
        swung_x, swung_y = c * before - s * beside, s * before + c * beside
        pose = np.array([scale * chord_x + swung_x - before, scale * chord_y + swung_y - beside, turn])
        # What turning does to the place: half of it to the chord, all of it to the mount.
        aside_x, aside_y = -scale / 2 * chord_y - swung_y, scale / 2 * chord_x + swung_x
        jacobian = np.array(
            [
                [chord_x, aside_x * turned, aside_x * way, c - 1, -s],
                [chord_y, aside_y * turned, aside_y * way, s, c - 1],
                [0.0, turned, way, 0.0, 0.0],
            ]
        )
        return pose, jacobian

    def _noise(self, wheels: Floats) -> Floats:
        settings, way = self.settings, hypot(wheels[0], wheels[1])
        distance = settings.distance_noise * way + settings.least_distance
        turn = settings.turn_noise * abs(float(wheels[2])) + settings.turn_per_metre * way + settings.least_turn
        return np.diag([distance**2, distance**2, turn**2])
