"""The mapper: scans go in one by one, poses come out at once; the graph of keyframes is mended when a loop closes."""

from dataclasses import dataclass, field
from itertools import pairwise
from time import perf_counter

import numpy as np

from backend.estimate import Decision, Estimate
from backend.factor_graph import FactorGraph, GraphSettings
from backend.joint_refinement import Chain, RefinementSettings, Sheaf, refine
from backend.landmark_map import LandmarkMap, LandmarkSettings
from backend.loop_closure import Candidate, Drift, LoopSettings, candidates
from backend.odometry import Move, Odometry, OdometrySettings
from frontend.local_map import Faces
from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from frontend.scan import Floats, Scan
from slam.logbook import Logbook
from slam.loops import Tried, VerificationSettings, close_loop
from slam.perception import FrontendSettings, Percept, perceive
from slam.tracking import Placed, TrackingSettings, track, turned


@dataclass(frozen=True)
class MapperSettings:
    """The settings of pose estimation, part by part."""

    odometry: OdometrySettings = field(default_factory=OdometrySettings)
    tracking: TrackingSettings = field(default_factory=TrackingSettings)
    loops: LoopSettings = field(default_factory=LoopSettings)
    verification: VerificationSettings = field(default_factory=VerificationSettings)
    landmarks: LandmarkSettings = field(default_factory=LandmarkSettings)
    graph: GraphSettings = field(default_factory=GraphSettings)
    refinement: RefinementSettings = field(default_factory=RefinementSettings)
    keyframe_metres: float = 0.15  # larger keeps fewer keyframes
    keyframe_radians: float = 0.3  # larger keeps fewer keyframes
    mend_metres: float = 0.05  # disagreement of a loop that mends the graph at once; larger mends less often
    mend_radians: float = 0.01
    loop_metres: float = 0.5  # way between two searches for loops; larger searches less often
    loop_radians: float = 0.5  # turn between two searches for loops; larger searches less often


class _Keyframe:
    """A scan that carries the graph: its place among the scans, and its faces in the room as now believed."""

    def __init__(self, scan: int, percept: Percept, pose: Floats) -> None:
        self.scan, self.percept, self.pose = scan, percept, pose
        self.slipped = False  # whether the wheels disagreed on the way here
        self._placed: tuple[Floats, Faces] | None = None

    @property
    def faces(self) -> Faces:
        """Placed only when somebody looks: a mended graph moves every keyframe, but few are looked at again."""
        if self._placed is None or self._placed[0] is not self.pose:
            self._placed = (self.pose, Faces.placed(self.percept.surface, self.pose))
        return self._placed[1]


class Mapper:
    """Grows with every scan; `result` may be asked for at any moment. A logbook with answers makes it go on there."""

    def __init__(self, frontend: FrontendSettings, settings: MapperSettings, logbook: Logbook | None = None) -> None:
        self.frontend, self.settings = frontend, settings
        self.logbook = logbook or Logbook()
        self.percepts: list[Percept] = []
        self.timings = {"front end": 0.0, "tracking": 0.0, "loops": 0.0, "graph": 0.0}
        self._odometry = Odometry(settings.odometry)
        self._graph = FactorGraph(settings.graph)
        self._landmarks = LandmarkMap(settings.landmarks)
        self._drift = Drift()
        self._keyframes: list[_Keyframe] = []
        self._relative: list[tuple[int, Floats]] = []  # keyframe and pose in its frame, one per scan
        self._decisions: list[Decision] = []
        self._slipped = False  # whether the wheels disagreed since the last keyframe
        self._way = np.zeros(2)  # metres and radians since loops were last searched

    def add(self, scan: Scan) -> Floats:
        """Take in the next scan; its pose (3,) in the frame of the first, as now believed."""
        clock = perf_counter()
        percept = perceive(scan, self.frontend)
        clock = self._tick("front end", clock)
        self.percepts.append(percept)
        if not self._keyframes:
            self._start(percept)
            return np.zeros(3)
        placed = self._track(percept)
        keyframe = self._keyframes[-1]
        step = between(keyframe.pose, placed.pose)
        clock = self._tick("tracking", clock)
        if np.hypot(*step[:2]) < self.settings.keyframe_metres and abs(step[2]) < self.settings.keyframe_radians:
            self._relative.append((len(self._keyframes) - 1, step))
            return placed.pose
        self._add_keyframe(percept, placed, step)
        clock = self._tick("graph", clock)
        surprise = self._close_loops()
        clock = self._tick("loops", clock)
        if surprise:
            self._graph.mend()
            self._settle()
        self._tick("graph", clock)
        return self._keyframes[-1].pose

    @property
    def poses(self) -> Floats:
        """(n, 3) where all scans so far were taken, as now believed; nothing is solved for it."""
        return np.array([compose(self._keyframes[k].pose, step) for k, step in self._relative]).reshape(-1, 3)

    def _settle(self) -> None:
        """Move keyframes and landmarks to where the graph now puts them."""
        poses = self._graph.poses
        for keyframe, pose in zip(self._keyframes, poses, strict=True):
            keyframe.pose = pose
        self._landmarks.settle(poses, np.array(self._graph.landmark_indices, np.int64), self._graph.landmarks)

    def result(self) -> Estimate:
        """The estimate after all scans so far; what comes later is the same whether it was asked for or not."""
        clock = perf_counter()
        graph = self._graph.solved()
        covariances = graph.covariances()
        poses = self._refined(graph.poses)
        self._tick("graph", clock)
        scale, turn_scale, turn_per_metre, forward, left = self._odometry.calibration
        return Estimate(
            poses=np.array([compose(poses[k], step) for k, step in self._relative]).reshape(-1, 3),
            covariances=covariances[np.array([k for k, _ in self._relative], np.int64)],
            landmarks=graph.landmarks,
            sightings=self._landmarks.counts[graph.landmark_indices],
            keyframes=np.array([keyframe.scan for keyframe in self._keyframes]),
            decisions=(*self._decisions, *self._doubted(graph)),
            calibration={
                "metres per metre": float(scale),
                "radians per radian": float(turn_scale),
                "radians per metre": float(turn_per_metre),
                "sensor forward": float(forward),
                "sensor left": float(left),
            },
            ties=tuple(graph.ties),
            landmark_ties=tuple(graph.landmark_ties),
        )

    def _refined(self, poses: Floats) -> Floats:
        """Poses (k, 3) of the keyframes after all faces and the wheels were solved together."""
        if len(poses) < 2:
            return poses
        surfaces = [keyframe.percept.surface for keyframe in self._keyframes]
        owners = np.repeat(np.arange(len(poses)), [len(surface.points) for surface in surfaces])
        sheaf = Sheaf(
            np.concatenate([surface.points for surface in surfaces]),
            np.concatenate([surface.normals for surface in surfaces]),
            np.concatenate([surface.spread for surface in surfaces]),
            owners,
        )
        driven = [self._driven(old, new) for old, new in pairwise(self._keyframes)]
        # Where the wheels slipped, the graph knows the move, and the wheels only how much may be believed.
        moves = [
            between(poses[k], poses[k + 1]) if self._keyframes[k + 1].slipped else move.pose
            for k, move in enumerate(driven)
        ]
        chain = Chain(np.array(moves), np.array([move.covariance for move in driven]))
        return refine(poses, sheaf, chain, self.settings.refinement)

    def _driven(self, old: _Keyframe, new: _Keyframe) -> Move:
        """What the wheels say of the way between two keyframes, covariance in the axes of the new one."""
        move = self._odometry.predict(between(old.percept.scan.odometry, new.percept.scan.odometry))
        return Move(move.pose, turned(move.covariance, -move.pose[2]))

    def _start(self, percept: Percept) -> None:
        pose = np.zeros(3)
        self._graph.add_pose(0, pose)
        self._graph.anchor(0, pose, np.diag([1e-3, 1e-3, 1e-4]) ** 2)
        self._keyframes.append(_Keyframe(0, percept, pose))
        self._relative.append((0, pose))
        self._see_landmarks(percept, pose)

    def _track(self, percept: Percept) -> Placed:
        """Place the newest scan and let the odometry learn from it."""
        index = len(self.percepts) - 1
        wheels = between(self.percepts[-2].scan.odometry, percept.scan.odometry)
        keyframe, step = self._relative[-1]
        last = compose(self._keyframes[keyframe].pose, step)
        move = self._odometry.predict(wheels)
        placed = self.logbook.answer(lambda: track(percept, last, move, self._recent(), self.settings.tracking))
        if placed.refused is not None:
            self._decisions.append(Decision("registration", (index,), accepted=False, reason=placed.refused))
            return placed
        moved = between(last, placed.pose)
        distance = self._odometry.learn(wheels, Move(moved, turned(placed.covariance, moved[2])))
        if distance > self.settings.odometry.slip_gate:
            reason = (
                f"the wheels claim {np.hypot(*wheels[:2]):.2f} m and {np.degrees(wheels[2]):.1f}°, registration says "
                f"{np.hypot(*moved[:2]):.2f} m and {np.degrees(moved[2]):.1f}°: {np.sqrt(distance):.1f} sigmas"
            )
            self._decisions.append(Decision("odometry", (index - 1, index), accepted=False, reason=reason))
            self._slipped = True
        return placed

    def _recent(self) -> list[Faces]:
        return [keyframe.faces for keyframe in self._keyframes[-self.settings.tracking.recent :]]

    def _add_keyframe(self, percept: Percept, placed: Placed, step: Floats) -> None:
        old, new = self._keyframes[-1], len(self._keyframes)
        self._keyframes.append(_Keyframe(len(self.percepts) - 1, percept, placed.pose))
        self._graph.add_pose(new, placed.pose)
        if placed.refused is None:
            self._graph.add_motion(new - 1, new, step, placed.covariance)
        self._keyframes[new].slipped = self._slipped and placed.refused is None
        if not self._keyframes[new].slipped:
            driven = self._driven(old, self._keyframes[new])
            self._graph.add_motion(new - 1, new, driven.pose, driven.covariance)
        self._slipped = False
        self._drift.add(new - 1, new, placed.covariance)
        self._way += np.array([np.hypot(*step[:2]), abs(step[2])])
        self._relative.append((new, np.zeros(3)))
        self._see_landmarks(percept, placed.pose)

    def _see_landmarks(self, percept: Percept, pose: Floats) -> None:
        for sighting in self._landmarks.see(len(self._keyframes) - 1, pose, percept.knots):
            if sighting.landmark not in self._graph.landmark_indices:
                self._graph.add_landmark(sighting.landmark, self._landmarks.positions[sighting.landmark])
            self._graph.add_sighting(sighting.pose, sighting.landmark, sighting.position, sighting.covariance)

    def _close_loops(self) -> bool:
        """Try the candidates of the newest keyframe; whether one disagreed enough to mend the graph at once."""
        if np.all(self._way < (self.settings.loop_metres, self.settings.loop_radians)):
            return False
        self._way = np.zeros(2)
        surprise = False
        newest = self._keyframes[-1]
        for tried in self.logbook.answer(self._tried_loops):
            found, scans = tried.found, (self._keyframes[tried.fixed].scan, newest.scan)
            if isinstance(found, str):
                self._decisions.append(Decision("loop", scans, accepted=False, reason=found))
                continue
            self._add_loop(tried.fixed, found)
            apart = between(newest.pose, found.pose_in_fixed)
            fit = f"{found.matched:.0%} matched, {found.residual * 100:.1f} cm rms"
            reason = f"{fit}, {np.hypot(*apart[:2]):.2f} m from the graph"
            self._decisions.append(Decision("loop", scans, accepted=True, reason=reason))
            surprise |= bool(
                np.hypot(*apart[:2]) > self.settings.mend_metres or abs(apart[2]) > self.settings.mend_radians
            )
        return surprise

    def _tried_loops(self) -> tuple[Tried, ...]:
        poses = np.array([keyframe.pose for keyframe in self._keyframes])
        found = candidates(poses, self._drift, self.settings.loops)
        return tuple(Tried(candidate.pose, self._verify(candidate)) for candidate in found)

    def _verify(self, candidate: Candidate) -> Alignment | str:
        beside, newest = self.settings.verification.beside, self._keyframes[-1]
        # Its neighbours' surface would be matched, but the loop would tie a pose that nothing holds to them.
        if len(self._keyframes[candidate.pose].percept.surface.points) < self.settings.tracking.least_faces:
            return "the old scan has no surface of its own"
        around = self._keyframes[max(0, candidate.pose - beside) : candidate.pose + beside + 1]
        old = Faces.together([keyframe.faces for keyframe in around])
        recent = Faces.together([keyframe.faces for keyframe in self._keyframes[-beside:]])
        window = (candidate.metres, candidate.radians)
        return close_loop(newest.percept, newest.pose, recent, old, window, self.settings.verification)

    def _add_loop(self, fixed: int, found: Alignment) -> None:
        pose = between(self._keyframes[fixed].pose, found.pose_in_fixed)
        own: Floats = np.asarray(np.linalg.inv(found.information + 1e-9 * np.eye(3)), np.float64)
        covariance = turned(own, -found.pose_in_fixed[2])
        # The submap itself is only as good as its own poses: nothing is known better than half a centimetre.
        covariance = covariance + np.diag([0.005, 0.005, 0.002]) ** 2
        newest = len(self._keyframes) - 1
        self._graph.add_loop(fixed, newest, pose, covariance)
        self._drift.add(fixed, newest, covariance)

    def _doubted(self, graph: FactorGraph) -> list[Decision]:
        """Loops that the rest of the graph contradicts, and knots that were not seen often enough to be landmarks."""
        needed = self.settings.landmarks.proven
        doubted = [
            Decision("landmark", tuple(self._keyframes[k].scan for k in poses), accepted=False, reason=reason)
            for poses in self._landmarks.unproven
            for reason in [f"a corner seen {len(poses)} times, but a landmark needs {needed} sightings"]
        ]
        for fixed, moving, sigmas in graph.loop_residuals():
            if sigmas > 5:
                scans = (self._keyframes[fixed].scan, self._keyframes[moving].scan)
                reason = f"the rest of the graph contradicts it by {sigmas:.1f} sigmas"
                doubted.append(Decision("loop", scans, accepted=False, reason=reason))
        return doubted

    def _tick(self, stage: str, since: float) -> float:
        now = perf_counter()
        self.timings[stage] += now - since
        return now
