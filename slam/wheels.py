"""The wheels of a drive: what they claim and how far each session's are trusted, learnt as scans are placed."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from backend.odometry import Move, Odometry, OdometrySettings
from frontend.rigid_motion import between
from frontend.scan import Floats
from slam.keyframes import Keyframe
from slam.perception import Percept
from slam.refining import UNKNOWN, wheels_say
from slam.tracking import Placed, turned

CONSTANTS = ("metres per metre", "radians per radian", "radians per metre", "sensor forward", "sensor left")


class Wheels:
    """One odometry filter per session, and the scans on the way to which the wheels were wrong."""

    def __init__(self, settings: OdometrySettings) -> None:
        self.settings = settings
        self.slipped = False  # whether they did since the last keyframe
        self._odometries: list[Odometry] = []
        self._slips: set[int] = set()

    @property
    def newest(self) -> Odometry:
        """The filter of the session that goes on."""
        return self._odometries[-1]

    @property
    def calibration(self) -> dict[str, float]:
        """The constants of the newest session's wheels."""
        odometry = self._odometries[-1] if self._odometries else Odometry(self.settings)
        return dict(zip(CONSTANTS, map(float, odometry.calibration), strict=True))

    def change_robot(self) -> None:
        """The next session may be another robot's: nothing is known of its wheels."""
        self._odometries.append(Odometry(self.settings))

    def begin_session(self, session: int) -> None:
        """A session begins; unless the robot was changed, its wheels are those of the session before."""
        if len(self._odometries) <= session:
            self._odometries += self._odometries[-1:] or [Odometry(self.settings)]
        self.newest.arrive()
        self.slipped = False

    def slip(self, scan: int) -> None:
        """On the way to this scan the wheels were no guide."""
        self._slips.add(scan)
        self.slipped = True

    def learn(self, wheels: Floats, moved: Floats, placed: Placed, seconds: float) -> str | None:
        """Learn from a registered move (3,) in so many seconds; why it was a slip, if so."""
        registered = Move(moved, turned(placed.measured, moved[2]))
        distance = self.newest.learn(wheels, registered, seconds)
        if distance <= self.settings.slip_gate:
            return None
        return (
            f"the wheels claim {np.hypot(*wheels[:2]):.2f} m and {np.degrees(wheels[2]):.1f}°, registration says "
            f"{np.hypot(*moved[:2]):.2f} m and {np.degrees(moved[2]):.1f}°: {np.sqrt(distance):.1f} sigmas"
        )

    def say(self, old: Keyframe, new: Percept) -> Move:
        """The way from a keyframe to a percept of its session, covariance in the axes of the new one."""
        return wheels_say(self._odometries[old.session], old.percept, new)

    def chain(
        self, poses: Floats, percepts: Sequence[Percept], sessions: Sequence[int], scans: list[int]
    ) -> list[Move]:
        """What is known without looking of the ways between successive ones of these scans, which is little where the
        wheels slipped and nothing between sessions."""
        return [self._move(poses, percepts, sessions, ends) for ends in pairwise(scans)]

    def _move(self, poses: Floats, percepts: Sequence[Percept], sessions: Sequence[int], ends: tuple[int, int]) -> Move:
        old, new = ends
        if sessions[old] != sessions[new]:
            return Move(between(poses[old], poses[new]), UNKNOWN)
        move = wheels_say(self._odometries[sessions[new]], percepts[old], percepts[new])
        return Move(between(poses[old], poses[new]), move.covariance) if new in self._slips else move
