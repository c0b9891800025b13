"""Doubted loops: found where more is doubted than was searched, they are believed when another view says the same.

The best place of a window is not the right one if that lies outside: the next niche of a corridor looks alike. Two
views of different surface are not deceived in the same way.
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
        far = [one for one, held in self._waiting if (held or firm) and self._way_from(one.moving) >= self.apart]
        earlier = next(
            (one for one in far if agreeing(newest, [one], graph.keyframes, self._drifted(one, newest))), None
        )
        if earlier is None:
            self._waiting += [(newest, firm)] * proposes
            graph.refuse("loop", scans, f"{found.matched:.0%} matched, not yet said by another view")
            return False
        graph.accept("loop", scans, f"{found.matched:.0%} matched, as said by another view")
        for one in (earlier, newest):
            graph.tie(one.fixed, one.moving, one.pose, one.covariance)
        graph.factors.believe(2)
        graph.factors.solve()
        graph.settle()
        return True

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

    def _way_from(self, keyframe: int) -> float:
        """Metres as the crow flies from a keyframe to the newest."""
        keyframes = self.graph.keyframes
        return float(np.hypot(*(keyframes[-1].pose - keyframes[keyframe].pose)[:2]))
