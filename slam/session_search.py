"""The search for other sessions' places: where one is recognised twice, two frames become one."""

from functools import partial

from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from slam.logbook import Logbook
from slam.loops import Tried, loop_covariance
from slam.mapper_settings import MapperSettings
from slam.pose_graph import PoseGraph
from slam.relocalisation import relocalise
from slam.sessions import Recognition


class SessionSearch:
    """Looks for the newest keyframe in the maps of sessions with other frames."""

    def __init__(self, settings: MapperSettings, graph: PoseGraph, logbook: Logbook) -> None:
        self.settings = settings
        self._graph, self._logbook = graph, logbook
        self.begin_session()

    def begin_session(self) -> None:
        """Nothing was looked for yet."""
        self._vain = 0  # searches since a place was found
        self._pause = 0  # searches to leave out

    def join_sessions(self) -> bool:
        """Look for the newest keyframe in the map of a session with another frame; whether the two were joined."""
        graph = self._graph
        if not graph.sessions.apart:
            return False
        self._pause -= 1
        if self._pause >= 0:
            return False
        # Looked for in vain, it is looked for less and less often; one map at a time keeps the time of a scan bounded.
        others = graph.sessions.others(graph.sessions.newest)
        root = others[self._vain % len(others)]
        self._vain += 1
        self._pause = self._vain // 10
        old = [k for k, keyframe in enumerate(graph.keyframes) if graph.sessions.root(keyframe.session) == root]
        tried = self._logbook.answer(partial(self._tried, old))
        scans = (graph.keyframes[old[tried.fixed]].scan, graph.keyframes[-1].scan)
        if isinstance(tried.found, str):
            graph.refuse("place", scans, tried.found)
            return False
        return self._confirmed(old[tried.fixed], tried.found, scans)

    def _tried(self, old: list[int]) -> Tried:
        settings, places = self.settings, [self._graph.keyframes[k] for k in old]
        recent = self._graph.last(settings.verification.beside)
        return relocalise(recent, places, settings.relocalisation, settings.verification)

    def _confirmed(self, fixed: int, alignment: Alignment, scans: tuple[int, int]) -> bool:
        graph = self._graph
        pose = between(graph.keyframes[fixed].pose, alignment.pose_in_fixed)
        found = Recognition(fixed, len(graph.keyframes) - 1, pose, loop_covariance(alignment))
        earlier = graph.sessions.confirm(found, graph.keyframes)
        if earlier is None:
            graph.refuse("place", scans, f"{alignment.matched:.0%} matched, not yet said by another view")
            return False
        graph.accept("place", scans, f"{alignment.matched:.0%} matched, as said by another view")
        self._join(earlier, found)
        return True

    def _join(self, earlier: Recognition, found: Recognition) -> None:
        """Lay the later of two sessions' maps on the earlier, and tie them by both recognitions."""
        graph = self._graph
        moved, carry = graph.sessions.join(found, graph.keyframes)
        graph.factors.carry({k: compose(carry, graph.keyframes[k].pose) for k in moved}, freed=moved[0])
        for one in (earlier, found):
            graph.tie(one.fixed, one.moving, one.pose, one.covariance)
        graph.factors.solve()
        graph.settle()
        self.begin_session()
