"""The pose graph of a drive: keyframes, the scans between them, landmarks and sessions, as they are now believed."""

import numpy as np

from backend.estimate import Decision
from backend.factor_graph import FactorGraph
from backend.landmark_map import LandmarkMap
from backend.loop_closure import Drift
from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from frontend.scan import Floats
from slam.keyframes import Keyframe, around
from slam.loops import loop_covariance
from slam.mapper_settings import MapperSettings
from slam.perception import Percept
from slam.sessions import Recognition, Sessions

FIRM = np.diag([1e-3, 1e-3, 1e-4]) ** 2  # covariance of a pose that is where it is by definition


class PoseGraph:
    """Grows by keyframes and by scans beside them; whoever finds out more about them adds factors and settles it."""

    def __init__(self, settings: MapperSettings) -> None:
        self.factors = FactorGraph(settings.graph)
        self._beside = settings.verification.beside
        self.landmarks = LandmarkMap(settings.landmarks)
        self.drift = Drift()
        self.sessions = Sessions()
        self.keyframes: list[Keyframe] = []
        self.relative: list[tuple[int, Floats]] = []  # keyframe and pose in its frame, one per scan
        self.decisions: list[Decision] = []
        self._settled = np.empty((0, 3))  # poses of the keyframes that were there when the graph was last solved

    @property
    def poses(self) -> Floats:
        """(n, 3) where all scans so far were taken, as now believed, each in its session's frame."""
        told = [
            self.sessions.told(compose(self.keyframes[k].pose, step), self.keyframes[k].session)
            for k, step in self.relative
        ]
        return np.array(told).reshape(-1, 3)

    @property
    def keyframe_poses(self) -> Floats:
        """(k, 3) where the keyframes are now believed to be, in the frame of the graph."""
        fresh = [keyframe.pose for keyframe in self.keyframes[len(self._settled) :]]
        return np.vstack([self._settled, *fresh])

    @property
    def last_pose(self) -> Floats:
        """(3,) of the newest scan, in the frame of the graph."""
        keyframe, step = self.relative[-1]
        return compose(self.keyframes[keyframe].pose, step)

    def last(self, count: int) -> list[Keyframe]:
        """The newest keyframes, of this session only."""
        return around(self.keyframes, len(self.keyframes) - 1, count - 1)

    def begin_session(self, scan: int, percept: Percept) -> Floats:
        """The scan is the first of a session; its pose (3,)."""
        number, pose = len(self.keyframes), self.sessions.begin()
        self.factors.add_pose(number, pose)
        self.factors.anchor(number, pose, FIRM)
        self.add_keyframe(Keyframe(scan, self.sessions.newest, percept, pose))
        return pose

    def add_keyframe(self, keyframe: Keyframe) -> None:
        """Another keyframe; the factors of its pose are the caller's to add."""
        self.relative.append((len(self.keyframes), np.zeros(3)))
        self.keyframes.append(keyframe)

    def add_beside(self, pose: Floats) -> None:
        """Another scan at a pose (3,) that goes along with the newest scan's keyframe."""
        keyframe = self.relative[-1][0]
        self.relative.append((keyframe, between(self.keyframes[keyframe].pose, pose)))

    def forget(self, first: int) -> None:
        """The scans from this one on, none of which is a keyframe, stand nowhere yet."""
        del self.relative[first:]

    def see_landmarks(self) -> None:
        """Match the newest keyframe's knots with the landmarks, and tie it to those that are proven."""
        newest = self.keyframes[-1]
        for sighting in self.landmarks.see(len(self.keyframes) - 1, newest.pose, newest.percept.knots):
            if sighting.landmark not in self.factors.landmark_indices:
                self.factors.add_landmark(sighting.landmark, self.landmarks.positions[sighting.landmark])
            self.factors.add_sighting(sighting.pose, sighting.landmark, sighting.position, sighting.covariance)

    def close(self, fixed: int, found: Alignment) -> None:
        """The newest keyframe was found on the surface around an earlier one."""
        recognised = self.recognised(fixed, found)
        self.tie(fixed, recognised.moving, recognised.pose, recognised.covariance)

    def recognised(self, fixed: int, found: Alignment) -> Recognition:
        """The newest keyframe on the surface around an earlier one, which is only as sure as its own poses."""
        submap = self.drift.of_submap(fixed, self._beside)
        pose = between(self.keyframes[fixed].pose, found.pose_in_fixed)
        return Recognition(fixed, len(self.keyframes) - 1, pose, loop_covariance(found, submap))

    def tie(self, fixed: int, moving: int, pose: Floats, covariance: Floats) -> None:
        """A keyframe was found at a pose (3,) in the frame of another, covariance (3, 3) in its own axes."""
        self.factors.add_loop(fixed, moving, pose, covariance)
        self.drift.add(fixed, moving, covariance)

    def settle(self) -> None:
        """Move keyframes and landmarks to where the factors now put them."""
        self.move_keyframes()
        proven = np.array(self.factors.landmark_indices, np.int64)
        self.landmarks.settle(self._settled, proven, self.factors.landmarks)

    def move_keyframes(self) -> None:
        """Move the keyframes to where the factors now put them."""
        self._settled = self.factors.poses
        for keyframe, pose in zip(self.keyframes, self._settled, strict=True):
            keyframe.pose = pose

    def accept(self, what: str, scans: tuple[int, ...], reason: str) -> None:
        """Something was believed about these scans, and why."""
        self.decisions.append(Decision(what, scans, accepted=True, reason=reason))

    def refuse(self, what: str, scans: tuple[int, ...], reason: str) -> None:
        """Something was not believed about these scans, and why."""
        self.decisions.append(Decision(what, scans, accepted=False, reason=reason))
