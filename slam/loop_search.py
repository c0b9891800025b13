"""The search for loops: where the newest keyframe may be looking at old surface, it is laid there and tied to it."""

from collections.abc import Callable

import numpy as np

from backend.loop_closure import Candidate, candidates
from frontend.local_map import Faces
from frontend.registration import Alignment
from frontend.rigid_motion import between
from frontend.scan import Floats
from slam.keyframes import around
from slam.logbook import Logbook
from slam.loops import Tried, VerificationSettings
from slam.mapper_settings import MapperSettings
from slam.perception import Percept
from slam.pose_graph import PoseGraph

Verify = Callable[[Percept, Floats, Faces, Faces, tuple[float, float], VerificationSettings], Alignment | str]


class LoopSearch:
    """Looks for loops now and then along the way. verify: lays a scan on old faces, as `slam.loops.close_loop` does."""

    def __init__(self, settings: MapperSettings, graph: PoseGraph, logbook: Logbook, verify: Verify) -> None:
        self.settings, self.verify = settings, verify
        self._graph, self._logbook = graph, logbook
        self._way = np.zeros(2)  # metres and radians since loops were last searched

    def moved(self, step: Floats) -> bool:
        """The robot went on by `step` (3,); whether it went far enough to search again."""
        self._way += np.array([np.hypot(*step[:2]), abs(step[2])])
        return bool(np.any(self._way >= (self.settings.loop_metres, self.settings.loop_radians)))

    def close_loops(self) -> bool:
        """Try the candidates of the newest keyframe; whether one disagreed enough to mend the graph at once."""
        self._way = np.zeros(2)
        surprise = False
        graph, newest = self._graph, self._graph.keyframes[-1]
        for tried in self._logbook.answer(self._tried):
            found, scans = tried.found, (graph.keyframes[tried.fixed].scan, newest.scan)
            if isinstance(found, str):
                graph.refuse("loop", scans, found)
                continue
            graph.close(tried.fixed, found)
            apart = between(newest.pose, found.pose_in_fixed)
            metres, radians = float(np.hypot(*apart[:2])), abs(float(apart[2]))
            fit = f"{found.matched:.0%} matched, {found.residual * 100:.1f} cm rms"
            graph.accept("loop", scans, f"{fit}, {metres:.2f} m from the graph")
            surprise |= metres > self.settings.mend_metres or radians > self.settings.mend_radians
        return surprise

    def _tried(self) -> tuple[Tried, ...]:
        found = candidates(self._graph.keyframe_poses, self._graph.drift, self.settings.loops)
        return tuple(Tried(candidate.pose, self._verified(candidate)) for candidate in found)

    def _verified(self, candidate: Candidate) -> Alignment | str:
        beside, keyframes = self.settings.verification.beside, self._graph.keyframes
        # Its neighbours' surface would be matched, but the loop would tie a pose that nothing holds to them.
        if len(keyframes[candidate.pose].percept.surface.points) < self.settings.tracking.least_faces:
            return "the old scan has no surface of its own"
        there = around(keyframes, candidate.pose, beside, beside)
        old = Faces.together([keyframe.faces for keyframe in there])
        recent = Faces.together([keyframe.faces for keyframe in self._graph.last(beside)])
        window, newest = (candidate.metres, candidate.radians), keyframes[-1]
        return self.verify(newest.percept, newest.pose, recent, old, window, self.settings.verification)
