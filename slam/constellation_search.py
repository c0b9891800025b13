"""The search for loops by constellations: where so much is doubted that no window covers it, corners say where.

The corners of the newest submap are laid on those of old places. What they propose must pass the test of a loop, and is
a doubted loop even then. In a corridor, only they say how far along it is.
"""

import numpy as np

from backend.loop_closure import Candidate
from frontend.corner_constellations import PlacedCorners, poses_of_corners
from frontend.local_map import Faces
from frontend.registration import Alignment
from frontend.rigid_motion import between
from frontend.scan import Booleans, Floats
from slam.doubted_loops import DoubtedLoops
from slam.keyframes import around
from slam.logbook import Logbook
from slam.loops import Tried, Verify
from slam.mapper_settings import MapperSettings
from slam.relocalisation import nearest_view

RIVAL = (0.5, 0.2)  # metres and radians from one another at which two poses that hold are two places


class ConstellationSearch:
    """Looks for the newest keyframe among old ones that may be anywhere. verify: as for other loops."""

    def __init__(self, settings: MapperSettings, doubted: DoubtedLoops, logbook: Logbook, verify: Verify) -> None:
        self.settings, self.verify = settings, verify
        self._graph, self._doubted, self._logbook = doubted.graph, doubted, logbook

    def find(self, old: list[Candidate]) -> bool:
        """Look for the newest keyframe at these places; whether it was found, and the graph solved anew."""
        if not old:
            return False
        graph, newest = self._graph, self._graph.keyframes[-1]
        holding: list[tuple[int, Alignment]] = []
        for tried in self._logbook.answer(lambda: self._tried(old)):
            if isinstance(tried.found, str):
                graph.refuse("loop", (graph.keyframes[tried.fixed].scan, newest.scan), tried.found)
            else:
                holding.append((tried.fixed, tried.found))
        rivals = [found.pose_in_fixed for _, found in holding]
        if _apart(rivals):
            for fixed, _ in holding:
                graph.refuse("loop", (graph.keyframes[fixed].scan, newest.scan), "another place holds the scan as well")
            return False
        return bool(holding) and self._doubted.weigh(*holding[0], proposes=True)

    def _tried(self, old: list[Candidate]) -> tuple[Tried, ...]:
        """The places that constellations propose, and what was found at each."""
        settings, graph = self.settings, self._graph
        newest, tried = graph.keyframes[-1], []
        window = (max(one.metres for one in old), max(one.radians for one in old))
        recent = Faces.together([keyframe.faces for keyframe in graph.last(settings.verification.beside)])
        there = [graph.keyframes[one.pose] for one in old]
        for pose in poses_of_corners(*self._corners(old), newest.pose, window, settings.constellations):
            nearest = old[nearest_view(pose, there, settings.loops.ahead)]
            tried.append(Tried(nearest.pose, self._verified(nearest, pose, recent)))
        return tuple(tried)

    def _corners(self, old: list[Candidate]) -> tuple[PlacedCorners, PlacedCorners]:
        """The corners first seen from the old places, and those seen from the newest keyframes."""
        known = self._graph.landmarks
        proven = known.counts >= self.settings.landmarks.proven
        recent = len(self._graph.keyframes) - self.settings.constellations.recent
        places = np.array([one.pose for one in old])
        return self._those(proven & np.isin(known.first_seen, places)), self._those(
            proven & (known.last_seen >= recent)
        )

    def _those(self, which: Booleans) -> PlacedCorners:
        known = self._graph.landmarks
        return PlacedCorners(known.positions[which], known.turns[which], known.headings[which])

    def _verified(self, candidate: Candidate, pose: Floats, recent: Faces) -> Alignment | str:
        """The newest scan laid on the old place from a proposed pose (3,)."""
        settings, graph = self.settings.verification, self._graph
        believed, percept = graph.keyframes[-1].pose, graph.keyframes[-1].percept
        off = between(believed, pose)
        metres, radians = float(np.hypot(*off[:2])), abs(float(off[2]))
        near = self.settings.loops.near
        if metres > candidate.metres + near or radians > candidate.radians:
            limit = f"{candidate.metres + near:.1f} m and {np.degrees(candidate.radians):.0f}°"
            return f"its corners ask for {metres:.1f} m and {np.degrees(radians):.0f}° more than is believed ({limit})"
        beside = around(graph.keyframes, candidate.pose, settings.beside, settings.beside)
        old = Faces.together([keyframe.faces for keyframe in beside])
        return self.verify(percept, pose, recent, old, (0.0, 0.0), settings)


def _apart(poses: list[Floats]) -> bool:
    """Whether some of the poses (3,) are another place than the first."""
    away = [between(poses[0], pose) for pose in poses[1:]]
    return any(np.hypot(*off[:2]) > RIVAL[0] or abs(off[2]) > RIVAL[1] for off in away)
