"""Steady motion: where a robot is to be expected when nobody tells how it moved, by how it moved of late.

Three forecasts compete on the newest moves that were seen: on as before in as many seconds, the same step again (logs
are often written step by step, not second by second), and standing. The one that usually held is asked.
"""

from collections import deque

import numpy as np

from backend.arcs import Floats


class SteadyMotion:
    """Foretells moves (3,) from earlier ones. doubts: metres and radians that a forecast is off at least, as a robot
    that only turned may drive on. remembered: how many newest moves say how far."""

    def __init__(self, doubts: tuple[float, float], remembered: int) -> None:
        self._doubts = np.array(doubts)
        self._surprises: deque[Floats] = deque(maxlen=remembered)  # (3, 2): metres and radians off, by each forecast
        self._step, self._speed = np.zeros(3), np.zeros(3)  # of the last move that was seen; per second
        self._lost = 0  # moves since then that led nobody knows where
        self._slid = 0  # moves since then that were seen but for how far they went

    def foretell(self, seconds: float) -> tuple[Floats, Floats]:
        """The move (3,) to expect in so many seconds, and its covariance (3, 3)."""
        off = np.array(self._surprises or [np.zeros((3, 2))])
        # A switch between driving and turning is a surprise for all: what usually holds decides.
        usual = int(np.argmin(np.median(off, axis=0) @ (1 / self._doubts)))
        metres, radians = np.maximum(np.sqrt(np.mean(off[:, usual] ** 2, axis=0)), self._doubts)
        # Nothing is expected from where the robot was lost; speeds nobody sees change as often as those that are seen.
        grown = (1 + self._lost) * np.sqrt(1 + self._slid)
        expected = np.zeros(3) if self._lost else self._forecasts(seconds)[usual]
        # It may stop, or turn back: three deviations reach beyond that, too.
        metres, radians = max(metres, np.hypot(*expected[:2]) / 2), radians + abs(expected[2]) / 2
        return expected, np.diag([grown * metres, grown * metres, grown * radians]) ** 2

    def see(self, move: Floats, seconds: float) -> None:
        """The robot moved by `move` (3,) in so many seconds."""
        if not self._lost and not self._slid:
            off = move - self._forecasts(seconds)
            self._surprises.append(np.column_stack([np.hypot(off[:, 0], off[:, 1]), np.abs(off[:, 2])]))
        known = move if not self._lost else np.zeros(3)  # the move began nobody knows where
        self._step, self._speed = known, known / max(seconds, 1e-3)
        self._lost = self._slid = 0

    def slide(self) -> None:
        """The robot went on, but nobody knows how far: it is expected to go as it did before."""
        self._slid += 1

    def lose(self) -> None:
        """The last move is not known at all: the next one begins nobody knows where."""
        self._lost += 1

    def arrive(self) -> None:
        """Wherever it came from, this is a place from which moves are told again."""
        self._lost = self._slid = 0
        self._step, self._speed = np.zeros(3), np.zeros(3)

    def _forecasts(self, seconds: float) -> Floats:
        """(3, 3): as many metres a second, as many a step, none."""
        return np.array([self._speed * max(seconds, 0.0), self._step, np.zeros(3)])
