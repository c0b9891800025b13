"""The mapper: scans go in one by one, poses come out at once; the graph of keyframes is mended when a loop closes."""

from time import perf_counter

import numpy as np

from backend.estimate import Estimate
from backend.odometry import Move
from frontend.rigid_motion import between
from frontend.scan import Floats, Scan
from slam.estimating import estimated
from slam.keyframes import Keyframe
from slam.logbook import Logbook
from slam.loop_search import LoopSearch
from slam.loops import Verify, close_loop
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings, Percept, perceive
from slam.pose_graph import PoseGraph
from slam.session_search import SessionSearch
from slam.sonar_mapping import SonarMapping
from slam.tracking import Placed, track, turned
from slam.wheels import Wheels


class Mapper:
    """Grows with every scan; `result` may be asked for at any moment. A logbook with answers makes it go on there.

    verify: what lays a scan on old faces to close a loop.
    """

    def __init__(
        self,
        frontend: FrontendSettings,
        settings: MapperSettings,
        logbook: Logbook | None = None,
        verify: Verify = close_loop,
    ) -> None:
        self.frontend, self.settings = frontend, settings
        self.logbook = logbook or Logbook()
        self.percepts: list[Percept] = []
        self.timings = {"front end": 0.0, "tracking": 0.0, "loops": 0.0, "graph": 0.0}
        self._graph = PoseGraph(settings)
        self._wheels = Wheels(settings.odometry)
        self._sonar = SonarMapping(settings, self._graph)
        self._loops = LoopSearch(settings, self._graph, self.logbook, verify)
        self._places = SessionSearch(settings, self._graph, self.logbook)
        self._cause: str | None = "the first scan"  # why the next scan begins a session
        self._astray: list[int] = []  # the newest scans, if they fit nowhere
        self._unmapped: set[int] = set()
        self._held = 0  # the earliest keyframe whose distance from the newest is known

    @property
    def poses(self) -> Floats:
        """(n, 3) where all scans so far were taken, as now believed; nothing is solved for it."""
        return self._graph.poses

    def begin_session(self, cause: str) -> None:
        """The next scan was taken nobody knows where, perhaps by another robot: it gets a frame of its own."""
        self._cause = cause
        self._astray.clear()
        self._wheels.change_robot()

    def add(self, scan: Scan) -> Floats:
        """Take in the next scan; its pose (3,) in the frame of its session's first, as now believed."""
        clock = perf_counter()
        self.percepts.append(perceive(scan, self.frontend))
        self._tick("front end", clock)
        pose = self._take(len(self.percepts) - 1)
        return self._graph.sessions.told(pose, self._graph.sessions.newest)

    def result(self) -> Estimate:
        """The estimate after all scans so far; what comes later is the same whether it was asked for or not."""
        clock = perf_counter()
        fitting = np.ones(len(self.percepts), np.bool_)
        fitting[sorted(self._unmapped)] = False
        found = estimated(self._graph, self._wheels, self.percepts, fitting, self.settings)
        self._tick("graph", clock)
        return found

    def _take(self, index: int) -> Floats:
        """Place a scan that was perceived; its pose (3,)."""
        if self._cause is not None:
            return self._start(index, self._cause)
        clock = perf_counter()
        if self.percepts[index].arcs is not None:
            pose = self._sonar.follow(index, self.percepts[index])
            self._tick("tracking", clock)
            return pose
        placed, gap = self._track(index)
        self._tick("tracking", clock)
        if placed.astray is not None:
            return self._wander(index, placed, gap)
        self._astray.clear()
        step = between(self._graph.keyframes[-1].pose, placed.pose)
        if np.hypot(*step[:2]) < self.settings.keyframe_metres and abs(step[2]) < self.settings.keyframe_radians:
            self._graph.add_beside(placed.pose)
            return placed.pose
        return self._keep(index, placed, step)

    def _start(self, index: int, cause: str) -> Floats:
        """A session begins with this scan."""
        graph, percept = self._graph, self.percepts[index]
        if graph.keyframes:
            graph.refuse("place", (index,), f"a session begins: {cause}")
        self._cause = None
        pose = graph.begin_session(index, percept)
        self._wheels.begin_session(graph.sessions.newest)
        self._places.begin_session()
        if percept.arcs is not None:
            self._sonar.begin_session(percept)
        else:
            graph.see_landmarks()
        return pose

    def _track(self, index: int) -> tuple[Placed, str | None]:
        """Place a scan after the one before it, and let the odometry learn from it; and why the wheels are no guide."""
        percept, before, last = self.percepts[index], self.percepts[index - 1], self._graph.last_pose
        wheels = between(before.scan.odometry, percept.scan.odometry)
        seconds, odometry = percept.scan.time - before.scan.time, self._wheels.newest
        move, gap = odometry.expect(wheels, seconds)
        placed = self._placed(percept, move)
        if odometry.broken:
            self._wheels.slip(index)
        elif placed.refused is not None:
            # It may be the wheels that are wrong.
            again, settings = self._placed(percept, odometry.steady(seconds)), self.settings.tracking
            wrong = again.matched >= settings.good or (again.fit >= settings.unguided.certain and not odometry.proven)
            placed = again if again.refused is None and wrong else placed
        if gap is not None:
            decide = self._graph.accept if placed.refused is None else self._graph.refuse
            decide("gap", (index - 1, index), gap)
            self._wheels.slip(index)
        if placed.refused is not None:
            self._graph.refuse("registration", (index,), placed.refused)
            odometry.lose()
        elif placed.slid is not None:
            self._graph.refuse("registration", (index - 1, index), placed.slid)
            moved = between(last, placed.pose)
            odometry.slide(wheels, Move(moved, turned(placed.measured, moved[2])))
            self._wheels.slip(index)
        elif gap is None:
            slipped = self._wheels.learn(wheels, between(last, placed.pose), placed, seconds)
            if slipped is not None:
                self._graph.refuse("odometry", (index - 1, index), slipped)
                self._wheels.slip(index)
        return placed, gap

    def _placed(self, percept: Percept, move: Move) -> Placed:
        """A scan placed after `move` from the newest, on what was seen since the robot last slid, or on more."""
        settings, last = self.settings.tracking, self._graph.last_pose
        recent = [keyframe.faces for keyframe in self._graph.last(settings.recent)]
        # Nobody knows how long a corridor was in which the robot slid: what lies before it is no map of what follows.
        held = recent[-max(len(self._graph.keyframes) - self._held, 1) :]
        placed = self.logbook.answer(lambda: track(percept, last, move, held, settings))
        if len(held) == len(recent) or placed.fit >= settings.unguided.sure:
            return placed
        whole = self.logbook.answer(lambda: track(percept, last, move, recent, settings))
        return max(placed, whole, key=lambda one: (one.refused is None, one.fit))

    def _wander(self, index: int, placed: Placed, gap: str | None) -> Floats:
        """A scan that fits nowhere waits for the next; when none of them fits, they begin a session together."""
        self._graph.add_beside(placed.pose)
        self._astray.append(index)
        self._unmapped.add(index)
        if gap is None and len(self._astray) < self.settings.patience:
            return placed.pose
        astray, self._astray = self._astray, []
        self._graph.forget(astray[0])
        self._unmapped.difference_update(astray)
        self._cause = f"{placed.astray}, {gap or f'{len(astray)} scans in a row'}"
        return [self._take(number) for number in astray][-1]

    def _keep(self, index: int, placed: Placed, step: Floats) -> Floats:
        """The scan becomes a keyframe, `step` (3,) after the one before; loops are looked for, and the graph mended."""
        clock, graph = perf_counter(), self._graph
        self._add_keyframe(index, placed, step)
        clock = self._tick("graph", clock)
        mend = False
        if self._loops.moved(step):
            surprised = self._loops.close_loops()
            mend = self._places.join_sessions() or surprised
        clock = self._tick("loops", clock)
        if mend:
            graph.factors.mend()
            graph.settle()
        self._tick("graph", clock)
        return graph.keyframes[-1].pose

    def _add_keyframe(self, index: int, placed: Placed, step: Floats) -> None:
        graph, percept = self._graph, self.percepts[index]
        old, new = graph.keyframes[-1], len(graph.keyframes)
        graph.factors.add_pose(new, placed.pose)
        if placed.refused is None or self._wheels.slipped:
            graph.factors.add_motion(new - 1, new, step, placed.measured)
        if not self._wheels.slipped:
            move = self._wheels.say(old, percept)
            graph.factors.add_motion(new - 1, new, move.pose, move.covariance)
        self._wheels.slipped = False
        graph.add_keyframe(Keyframe(index, old.session, percept, placed.pose))
        graph.drift.add(new - 1, new, placed.covariance)
        if placed.slid is not None:
            self._held = new
        graph.see_landmarks()

    def _tick(self, stage: str, since: float) -> float:
        now = perf_counter()
        self.timings[stage] += now - since
        return now
