"""The search for loops: where the newest keyframe may be looking at old surface, it is laid there and tied to it."""

import numpy as np

from backend.loop_closure import Candidate, beyond_search, candidates, outlook
from frontend.local_map import Faces
from frontend.registration import Alignment
from frontend.rigid_motion import between
from frontend.scan import Floats
from slam.constellation_search import ConstellationSearch
from slam.doubted_loops import DoubtedLoops
from slam.keyframes import around
from slam.logbook import Logbook
from slam.loops import Tried, Verify
from slam.mapper_settings import MapperSettings
from slam.pose_graph import PoseGraph


class LoopSearch:
    """Looks for loops now and then along the way. verify: lays a scan on old faces, as `slam.loops.close_loop` does."""

    def __init__(self, settings: MapperSettings, graph: PoseGraph, logbook: Logbook, verify: Verify) -> None:
        self.settings, self.verify = settings, verify
        self._graph, self._logbook = graph, logbook
        self._doubted = DoubtedLoops(graph, settings.loops, settings.verification.firmness)
        self._constellations = ConstellationSearch(settings, self._doubted, logbook, verify)
        self._way = np.zeros(2)  # metres and radians since loops were last searched

    def moved(self, step: Floats) -> bool:
        """The robot went on by `step` (3,); whether it went far enough to search again."""
        self._way += np.array([np.hypot(*step[:2]), abs(step[2])])
        return bool(np.any(self._way >= (self.settings.loop_metres, self.settings.loop_radians)))

    def close_loops(self) -> bool:
        """Try the candidates of the newest keyframe; whether one disagreed enough to mend the graph at once.

        Where the pose says too little to search, or the search finds nothing, constellations of corners propose.
        """
        self._way = np.zeros(2)
        graph, settings = self._graph, self.settings.loops
        seen = outlook(graph.keyframe_poses, graph.drift, settings)
        asked = candidates(seen, graph.drift, settings)
        tried = self._logbook.answer(lambda: tuple(Tried(one.pose, self._verified(one)) for one in asked))
        surprise = False
        for one, where in zip(tried, asked, strict=True):
            disagrees = self._decided(one, where.covered)
            surprise |= disagrees
            if disagrees and not where.covered:
                break  # the graph was solved anew: what else was found lies on keyframes that have moved since
        return surprise or self._constellations.find(beyond_search(seen, graph.drift, settings))

    def _decided(self, tried: Tried, covered: bool) -> bool:
        """Tie what was found, at once if all that is doubted was searched; whether it disagrees with the graph."""
        graph, newest, found = self._graph, self._graph.keyframes[-1], tried.found
        scans = (graph.keyframes[tried.fixed].scan, newest.scan)
        if isinstance(found, str):
            graph.refuse("loop", scans, found)
            return False
        if not covered:
            return self._doubted.weigh(tried.fixed, found, proposes=False)
        graph.close(tried.fixed, found)
        apart = between(newest.pose, found.pose_in_fixed)
        metres, radians = float(np.hypot(*apart[:2])), abs(float(apart[2]))
        fit = f"{found.matched:.0%} matched, {found.residual * 100:.1f} cm rms"
        graph.accept("loop", scans, f"{fit}, {metres:.2f} m from the graph")
        return metres > self.settings.mend_metres or radians > self.settings.mend_radians

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
