"""The mapper: scans go in one by one, poses come out at once; the graph of keyframes is mended when a loop closes."""

from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from time import perf_counter

import numpy as np

from backend.estimate import Decision, Estimate
from backend.factor_graph import FactorGraph, GraphSettings
from backend.joint_refinement import RefinementSettings
from backend.landmark_map import LandmarkMap, LandmarkSettings
from backend.loop_closure import Candidate, Drift, LoopSettings, candidates
from backend.odometry import Move, Odometry, OdometrySettings
from backend.wheel_noise import driven
from frontend.local_map import Faces
from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from frontend.scan import Floats, Scan
from slam.arc_tracking import ArcTracking, ArcTrackingSettings
from slam.keyframes import Keyframe, around
from slam.logbook import Logbook
from slam.loops import Tried, VerificationSettings, close_loop
from slam.main_map import landmarks_in, left_out, main_root
from slam.perception import FrontendSettings, Percept, perceive
from slam.refining import UNKNOWN, refined, wheels_say
from slam.relocalisation import RelocalisationSettings, relocalise
from slam.sessions import Recognition, Sessions
from slam.tracking import Placed, TrackingSettings, track, turned


@dataclass(frozen=True)
class MapperSettings:
    """The settings of pose estimation, part by part."""

    odometry: OdometrySettings = field(default_factory=OdometrySettings)
    tracking: TrackingSettings = field(default_factory=TrackingSettings)
    loops: LoopSettings = field(default_factory=LoopSettings)
    verification: VerificationSettings = field(default_factory=VerificationSettings)
    relocalisation: RelocalisationSettings = field(default_factory=RelocalisationSettings)
    arcs: ArcTrackingSettings = field(default_factory=ArcTrackingSettings)
    landmarks: LandmarkSettings = field(default_factory=LandmarkSettings)
    graph: GraphSettings = field(default_factory=GraphSettings)
    refinement: RefinementSettings = field(default_factory=RefinementSettings)
    keyframe_metres: float = 0.3  # larger keeps fewer keyframes
    keyframe_radians: float = 0.3  # larger keeps fewer keyframes
    mend_metres: float = 0.05  # disagreement of a loop that mends the graph at once; larger mends less often
    mend_radians: float = 0.01
    loop_metres: float = 1.0  # way between two searches for loops; larger searches less often
    loop_radians: float = 1.0  # turn between two searches for loops; larger searches less often
    patience: int = 3  # scans in a row that fit nowhere before the robot is lost; larger waits for people to pass


class Mapper:
    """Grows with every scan; `result` may be asked for at any moment. A logbook with answers makes it go on there."""

    def __init__(self, frontend: FrontendSettings, settings: MapperSettings, logbook: Logbook | None = None) -> None:
        self.frontend, self.settings = frontend, settings
        self.logbook = logbook or Logbook()
        self.percepts: list[Percept] = []
        self.timings = {"front end": 0.0, "tracking": 0.0, "loops": 0.0, "graph": 0.0}
        self._odometries: list[Odometry] = []  # one per session
        self._sessions = Sessions()
        self._cause: str | None = "the first scan"  # why the next scan begins a session
        self._astray: list[int] = []  # the newest scans, if they fit nowhere
        self._unmapped: set[int] = set()
        self._graph = FactorGraph(settings.graph)
        self._landmarks = LandmarkMap(settings.landmarks)
        self._arcs = ArcTracking(settings.arcs)
        self._drift = Drift()
        self._keyframes: list[Keyframe] = []
        self._settled = np.empty((0, 3))  # poses of the keyframes that were there when the graph was last solved
        self._relative: list[tuple[int, Floats]] = []  # keyframe and pose in its frame, one per scan
        self._decisions: list[Decision] = []
        self._slips: set[int] = set()  # scans on the way to which the wheels disagreed
        self._slipped = False  # whether they did since the last keyframe
        self._way = np.zeros(2)  # metres and radians since loops were last searched
        self._vain = 0  # searches for another session's places since one was found, and how many to leave out
        self._pause = 0

    def begin_session(self, cause: str) -> None:
        """The next scan was taken nobody knows where, perhaps by another robot: it gets a frame of its own."""
        self._cause = cause
        self._astray.clear()
        self._odometries.append(Odometry(self.settings.odometry))

    def add(self, scan: Scan) -> Floats:
        """Take in the next scan; its pose (3,) in the frame of its session's first, as now believed."""
        clock = perf_counter()
        self.percepts.append(perceive(scan, self.frontend))
        self._tick("front end", clock)
        pose = self._take(len(self.percepts) - 1)
        return self._sessions.told(pose, self._sessions.newest)

    def _take(self, index: int) -> Floats:
        """Place a scan that was perceived; its pose (3,)."""
        clock = perf_counter()
        if self._cause is not None:
            return self._start(index)
        if self.percepts[index].arcs is not None:
            return self._follow(index)
        placed, gap = self._track(index)
        if placed.astray is not None:
            return self._wander(index, placed, gap)
        self._astray.clear()
        keyframe = self._keyframes[-1]
        step = between(keyframe.pose, placed.pose)
        clock = self._tick("tracking", clock)
        if np.hypot(*step[:2]) < self.settings.keyframe_metres and abs(step[2]) < self.settings.keyframe_radians:
            self._relative.append((len(self._keyframes) - 1, step))
            return placed.pose
        self._add_keyframe(index, placed, step)
        clock = self._tick("graph", clock)
        surprise = self._close_loops()
        clock = self._tick("loops", clock)
        if surprise:
            self._graph.mend()
            self._settle()
        self._tick("graph", clock)
        return self._keyframes[-1].pose

    def _follow(self, index: int) -> Floats:
        """Place a scan of a wide beam by its arcs; its pose (3,). Every one of them carries the graph."""
        percept, old, new = self.percepts[index], self._keyframes[-1], len(self._keyframes)
        assert percept.arcs is not None
        wheels = between(old.percept.scan.odometry, percept.scan.odometry)
        recent = [keyframe.faces for keyframe in self._last(self.settings.arcs.recent)]
        clock = perf_counter()
        pose, covariance, recognised = self._arcs.follow(
            self._graph, percept.arcs, percept.surface, recent, driven(wheels, self.settings.odometry)
        )
        self._tick("tracking", clock)
        self._keyframes.append(Keyframe(index, old.session, percept, pose))
        self._relative.append((new, np.zeros(3)))
        self._drift.add(new - 1, new, covariance)
        for keyframe, moved in zip(self._keyframes, self._graph.poses, strict=True):
            keyframe.pose = moved
        if not recognised:
            reason = f"none of its {len(percept.arcs.ranges)} walls and edges was recognised: placed by the wheels"
            self._decisions.append(Decision("registration", (index,), accepted=False, reason=reason))
        return pose

    @property
    def poses(self) -> Floats:
        """(n, 3) where all scans so far were taken, as now believed; nothing is solved for it."""
        told = [
            self._sessions.told(compose(self._keyframes[k].pose, step), self._keyframes[k].session)
            for k, step in self._relative
        ]
        return np.array(told).reshape(-1, 3)

    def _settle(self) -> None:
        """Move keyframes and landmarks to where the graph now puts them."""
        poses = self._graph.poses
        self._settled = poses
        for keyframe, pose in zip(self._keyframes, poses, strict=True):
            keyframe.pose = pose
        self._landmarks.settle(poses, np.array(self._graph.landmark_indices, np.int64), self._graph.landmarks)

    def result(self) -> Estimate:
        """The estimate after all scans so far; what comes later is the same whether it was asked for or not."""
        clock = perf_counter()
        graph = self._graph.solved()
        covariances = graph.covariances()
        solved = graph.poses
        poses = np.array([compose(solved[k], step) for k, step in self._relative]).reshape(-1, 3)
        # Outlines that a wide beam smeared must not pull at poses that arcs have placed.
        by_arcs = any(keyframe.percept.arcs is not None for keyframe in self._keyframes)
        poses = poses if by_arcs else self._refined(poses)
        self._tick("graph", clock)
        owners = np.array([k for k, _ in self._relative], np.int64)
        roots = np.array([self._sessions.root(keyframe.session) for keyframe in self._keyframes], np.int64)
        main = main_root(roots[owners])
        landmarks, kept, landmark_ties = landmarks_in(graph, roots == main)
        counts = self._arcs.counts if by_arcs else self._landmarks.counts[graph.landmark_indices]
        told = [self._sessions.told(pose, self._keyframes[k].session) for pose, k in zip(poses, owners, strict=True)]
        mapped = roots[owners] == main
        mapped[sorted(self._unmapped)] = False
        return Estimate(
            poses=np.array(told).reshape(-1, 3),
            covariances=covariances[owners],
            landmarks=landmarks - self._sessions.start(main)[:2],
            sightings=counts[kept],
            keyframes=np.array([keyframe.scan for keyframe in self._keyframes]),
            decisions=(*self._decisions, *self._doubted(graph), *left_out(roots[owners], main)),
            calibration=self._calibration(),
            mapped=mapped,
            ties=tuple(graph.ties),
            landmark_ties=landmark_ties,
        )

    def _calibration(self) -> dict[str, float]:
        """The constants of the newest session's wheels."""
        odometry = self._odometries[-1] if self._odometries else Odometry(self.settings.odometry)
        names = ("metres per metre", "radians per radian", "radians per metre", "sensor forward", "sensor left")
        return dict(zip(names, map(float, odometry.calibration), strict=True))

    def _refined(self, poses: Floats) -> Floats:
        """Poses (n, 3) of all scans after their faces and the wheels were solved together; unmapped ones stay."""
        used = np.setdiff1d(np.arange(len(poses)), sorted(self._unmapped))
        refined_poses = poses.copy()
        moves = [self._move(poses, old, new) for old, new in pairwise(used.tolist())]
        percepts = [self.percepts[scan] for scan in used]
        refined_poses[used] = refined(poses[used], percepts, moves, self.settings.refinement)
        return refined_poses

    def _move(self, poses: Floats, old: int, new: int) -> Move:
        """What is known of the way between two scans without looking: where the wheels slipped, how little."""
        session = self._keyframes[self._relative[new][0]].session
        if self._keyframes[self._relative[old][0]].session != session:
            return Move(between(poses[old], poses[new]), UNKNOWN)
        move = wheels_say(self._odometries[session], self.percepts[old], self.percepts[new])
        return Move(between(poses[old], poses[new]), move.covariance) if new in self._slips else move

    def _start(self, index: int) -> Floats:
        """A session begins with this scan."""
        number, pose = len(self._keyframes), self._sessions.begin()
        if len(self._odometries) <= self._sessions.newest:
            self._odometries += self._odometries[-1:] or [Odometry(self.settings.odometry)]
        if number:
            self._decisions.append(
                Decision("place", (index,), accepted=False, reason=f"a session begins: {self._cause}")
            )
        self._cause, self._slipped, self._vain, self._pause = None, False, 0, 0
        self._graph.add_pose(number, pose)
        self._graph.anchor(number, pose, np.diag([1e-3, 1e-3, 1e-4]) ** 2)
        self._keyframes.append(Keyframe(index, self._sessions.newest, self.percepts[index], pose))
        self._relative.append((number, np.zeros(3)))
        if (arcs := self.percepts[index].arcs) is not None:
            self._arcs.start(self._graph, number, arcs)
        else:
            self._see_landmarks(self.percepts[index], pose)
        return pose

    def _track(self, index: int) -> tuple[Placed, str | None]:
        """Place a scan after the one before it, and let the odometry learn from it; and why the wheels are no guide."""
        percept, before = self.percepts[index], self.percepts[index - 1]
        wheels = between(before.scan.odometry, percept.scan.odometry)
        keyframe, step = self._relative[-1]
        last = compose(self._keyframes[keyframe].pose, step)
        odometry = self._odometries[self._sessions.newest]
        seconds = percept.scan.time - before.scan.time
        move, gap = odometry.expect(wheels, seconds)
        placed = self.logbook.answer(lambda: track(percept, last, move, self._recent(), self.settings.tracking))
        if placed.astray is not None:
            # It may be the wheels that are wrong.
            steady = odometry.steady(seconds)
            again = self.logbook.answer(lambda: track(percept, last, steady, self._recent(), self.settings.tracking))
            placed = again if again.refused is None and again.matched >= self.settings.tracking.good else placed
        if gap is not None:
            self._decisions.append(Decision("gap", (index - 1, index), accepted=placed.refused is None, reason=gap))
            self._slips.add(index)
            self._slipped = True
        if placed.refused is not None:
            self._decisions.append(Decision("registration", (index,), accepted=False, reason=placed.refused))
        elif gap is None:
            moved = between(last, placed.pose)
            distance = odometry.learn(wheels, Move(moved, turned(placed.measured, moved[2])), seconds)
            if distance > self.settings.odometry.slip_gate:
                self._slip(index, wheels, moved, distance)
        return placed, gap

    def _slip(self, index: int, wheels: Floats, moved: Floats, distance: float) -> None:
        reason = (
            f"the wheels claim {np.hypot(*wheels[:2]):.2f} m and {np.degrees(wheels[2]):.1f}°, registration says "
            f"{np.hypot(*moved[:2]):.2f} m and {np.degrees(moved[2]):.1f}°: {np.sqrt(distance):.1f} sigmas"
        )
        self._decisions.append(Decision("odometry", (index - 1, index), accepted=False, reason=reason))
        self._slips.add(index)
        self._slipped = True

    def _wander(self, index: int, placed: Placed, gap: str | None) -> Floats:
        """A scan that fits nowhere waits for the next; when none of them fits, they begin a session together."""
        keyframe = self._relative[-1][0]
        self._relative.append((keyframe, between(self._keyframes[keyframe].pose, placed.pose)))
        self._astray.append(index)
        self._unmapped.add(index)
        if gap is None and len(self._astray) < self.settings.patience:
            return placed.pose
        astray, self._astray = self._astray, []
        del self._relative[astray[0] :]
        self._unmapped.difference_update(astray)
        self._cause = f"{placed.astray}, {gap or f'{len(astray)} scans in a row'}"
        return [self._take(number) for number in astray][-1]

    def _recent(self) -> list[Faces]:
        return [keyframe.faces for keyframe in self._last(self.settings.tracking.recent)]

    def _last(self, count: int) -> list[Keyframe]:
        """The newest keyframes, of this session only."""
        return around(self._keyframes, len(self._keyframes) - 1, count - 1)

    def _add_keyframe(self, index: int, placed: Placed, step: Floats) -> None:
        old, new, percept = self._keyframes[-1], len(self._keyframes), self.percepts[index]
        self._keyframes.append(Keyframe(index, old.session, percept, placed.pose))
        self._graph.add_pose(new, placed.pose)
        if placed.refused is None or self._slipped:
            self._graph.add_motion(new - 1, new, step, placed.measured)
        if not self._slipped:
            move = wheels_say(self._odometries[old.session], old.percept, percept)
            self._graph.add_motion(new - 1, new, move.pose, move.covariance)
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
        return self._recognise() or surprise

    def _recognise(self) -> bool:
        """Look for the newest keyframe in the map of a session with another frame; whether the two were joined."""
        if not self._sessions.apart:
            return False
        self._pause -= 1
        if self._pause >= 0:
            return False
        # Looked for in vain, it is looked for less and less often; one map at a time keeps the time of a scan bounded.
        newest, others = self._keyframes[-1], self._sessions.others(self._sessions.newest)
        root = others[self._vain % len(others)]
        self._vain += 1
        self._pause = self._vain // 10
        old = [k for k, keyframe in enumerate(self._keyframes) if self._sessions.root(keyframe.session) == root]
        tried = self.logbook.answer(partial(self._tried_place, old))
        fixed = old[tried.fixed]
        scans = (self._keyframes[fixed].scan, newest.scan)
        if isinstance(tried.found, str):
            self._decisions.append(Decision("place", scans, accepted=False, reason=tried.found))
            return False
        pose = between(self._keyframes[fixed].pose, tried.found.pose_in_fixed)
        found = Recognition(fixed, len(self._keyframes) - 1, pose, _covariance(tried.found))
        earlier = self._sessions.confirm(found, self._keyframes)
        reason = f"{tried.found.matched:.0%} matched, {'as' if earlier else 'not yet'} said by another view"
        self._decisions.append(Decision("place", scans, accepted=earlier is not None, reason=reason))
        if earlier is not None:
            self._join(earlier, found)
        return earlier is not None

    def _tried_place(self, old: list[int]) -> Tried:
        settings, places = self.settings, [self._keyframes[k] for k in old]
        return relocalise(
            self._last(settings.verification.beside), places, settings.relocalisation, settings.verification
        )

    def _join(self, earlier: Recognition, found: Recognition) -> None:
        """Lay the later of two sessions' maps on the earlier, and tie them by both recognitions."""
        moved, carry = self._sessions.join(found, self._keyframes)
        poses = {k: compose(carry, self._keyframes[k].pose) for k in moved}
        self._graph.carry(poses, freed=moved[0])
        for one in (earlier, found):
            self._graph.add_loop(one.fixed, one.moving, one.pose, one.covariance)
            self._drift.add(one.fixed, one.moving, one.covariance)
        self._graph.solve()
        self._settle()
        self._vain = self._pause = 0

    def _tried_loops(self) -> tuple[Tried, ...]:
        fresh = [keyframe.pose for keyframe in self._keyframes[len(self._settled) :]]
        poses = np.vstack([self._settled, *fresh])
        found = candidates(poses, self._drift, self.settings.loops)
        return tuple(Tried(candidate.pose, self._verify(candidate)) for candidate in found)

    def _verify(self, candidate: Candidate) -> Alignment | str:
        beside, newest = self.settings.verification.beside, self._keyframes[-1]
        # Its neighbours' surface would be matched, but the loop would tie a pose that nothing holds to them.
        if len(self._keyframes[candidate.pose].percept.surface.points) < self.settings.tracking.least_faces:
            return "the old scan has no surface of its own"
        there = around(self._keyframes, candidate.pose, beside, beside)
        old = Faces.together([keyframe.faces for keyframe in there])
        recent = Faces.together([keyframe.faces for keyframe in self._last(beside)])
        window = (candidate.metres, candidate.radians)
        return close_loop(newest.percept, newest.pose, recent, old, window, self.settings.verification)

    def _add_loop(self, fixed: int, found: Alignment) -> None:
        newest, covariance = len(self._keyframes) - 1, _covariance(found)
        self._graph.add_loop(fixed, newest, between(self._keyframes[fixed].pose, found.pose_in_fixed), covariance)
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


def _covariance(found: Alignment) -> Floats:
    """(3, 3) of a pose on an old submap, in its own axes."""
    own: Floats = np.asarray(np.linalg.inv(found.information + 1e-9 * np.eye(3)), np.float64)
    # The submap itself is only as good as its own poses: nothing is known better than half a centimetre.
    return np.asarray(turned(own, -found.pose_in_fixed[2]) + np.diag([0.005, 0.005, 0.002]) ** 2)
