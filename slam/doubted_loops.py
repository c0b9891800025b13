"""Doubted loops: found where more is doubted than was searched, they are believed when another view says the same.

The best place of a window is not the right one if that lies outside: the next niche of a corridor looks alike. Two
views of different surface are seldom deceived in the same way; they are where every room is the next one's twin, and
more is doubted than a room is long.
"""

import numpy as np

from backend.loop_closure import LoopSettings
from frontend.registration import Alignment
from slam.pose_graph import PoseGraph
from slam.sessions import Recognition, agreeing

LEAST = (0.1, 0.03)  # metres and radians by which the same loop may be found differently
WIDEST = (1.0, 0.1)  # and by which, however much drifted in between, it may not


class DoubtedLoops:
    """Those of a drive that no other view has confirmed."""

    def __init__(self, graph: PoseGraph, settings: LoopSettings, firmness: float) -> None:
        self.graph, self.apart, self.sigmas, self.firmness = graph, settings.confirmed, settings.sigmas, firmness
        self._waiting: list[tuple[Recognition, bool]] = []  # and whether the surface held it in every direction

    def weigh(self, fixed: int, found: Alignment, proposes: bool) -> bool:
        """The newest keyframe was found on the surface around an earlier one; whether that is now believed, and the
        graph solved anew. proposes: whether it may wait for another view that says the same, not only confirm one.
        """
        graph, moving = self.graph, len(self.graph.keyframes) - 1
        scans = (graph.keyframes[fixed].scan, graph.keyframes[moving].scan)
        newest = graph.recognised(fixed, found)
        # Two views may share the corners that say how far along a corridor they are: surface must say it of one.
        firm = found.firmness >= self.firmness
        asked = [one for one, held in self._waiting if held or firm]
        earlier = next((one for one in asked if self._another_view(one) and self._alike(one, newest)), None)
        if earlier is None:
            self._waiting += [(newest, firm)] * proposes
            graph.refuse("loop", scans, f"{found.matched:.0%} matched, not yet said by another view")
            return False
        self._waiting = [(one, held) for one, held in self._waiting if one is not earlier]
        then = (graph.keyframes[earlier.fixed].scan, graph.keyframes[earlier.moving].scan)
        graph.accept("loop", then, f"said again by scan {scans[1]}")
        graph.accept("loop", scans, f"{found.matched:.0%} matched, as said by scan {then[1]}")
        for one in (earlier, newest):
            graph.tie(one.fixed, one.moving, one.pose, one.covariance)
        graph.factors.believe(2)
        graph.factors.solve()
        graph.settle()
        return True

    def _another_view(self, earlier: Recognition) -> bool:
        """Whether one that waits was seen in the frame of the newest keyframe, and from far enough away."""
        then, now = self.graph.keyframes[earlier.moving], self.graph.keyframes[-1]
        frame = self.graph.sessions.root
        return frame(then.session) == frame(now.session) and np.hypot(*(now.pose - then.pose)[:2]) >= self.apart

    def _alike(self, earlier: Recognition, newest: Recognition) -> bool:
        """Whether both say the same; how much may have drifted between them is worked out only where they may."""
        keyframes = self.graph.keyframes
        return (
            agreeing(newest, [earlier], keyframes, WIDEST) is not None
            and agreeing(newest, [earlier], keyframes, self._drifted(earlier, newest)) is not None
        )

    def _drifted(self, earlier: Recognition, newest: Recognition) -> tuple[float, float]:
        """Metres and radians that two true loops may differ, as the drive drifts from one to the other at both ends."""
        drift, sigmas, poses = self.graph.drift, self.sigmas, self.graph.keyframe_poses
        squares = np.zeros(2)
        for here, there in ((newest.moving, earlier.moving), (newest.fixed, earlier.fixed)):
            squares += (
                drift.place_from(here, poses[:, :2])[there] ** 2,
                drift.heading_from(here, len(poses))[there] ** 2,
            )
        metres, radians = np.clip(np.add(LEAST, sigmas * np.sqrt(squares)), LEAST, WIDEST)
        return float(metres), float(radians)
