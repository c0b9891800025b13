"""The search for other sessions' places: where one is recognised twice, two frames become one."""

from collections import Counter
from functools import partial

from frontend.registration import Alignment
from frontend.rigid_motion import compose
from slam.logbook import Logbook
from slam.loops import Tried
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
        self._vain: Counter[tuple[int, int]] = Counter()  # searches in each piece of map since a place was found
        self._pause = 0  # searches to leave out

    def join_sessions(self) -> bool:
        """Look for the newest keyframe in the map of a session with another frame; whether the two were joined."""
        graph = self._graph
        if not graph.sessions.apart:
            return False
        self._pause -= 1
        if self._pause >= 0:
            return False
        # Looked for in vain, it is looked for less and less often; a piece of map at a time bounds the time of a scan.
        pieces = self._pieces()
        piece = max(pieces, key=lambda one: len(pieces[one]) / (1 + self._vain[one]))
        self._vain[piece] += 1
        self._pause = 2 + self._vain.total() // 10
        old = pieces[piece]
        tried = self._logbook.answer(partial(self._tried, old))
        scans = (graph.keyframes[old[tried.fixed]].scan, graph.keyframes[-1].scan)
        if isinstance(tried.found, str):
            graph.refuse("place", scans, tried.found)
            return False
        return self._confirmed(old[tried.fixed], tried.found, scans)

    def _pieces(self) -> dict[tuple[int, int], list[int]]:
        """The keyframes of other frames than the newest one's, by root and place in its map, at most `piece` each."""
        graph, size = self._graph, self.settings.relocalisation.piece
        found: dict[int, list[int]] = {root: [] for root in graph.sessions.others(graph.sessions.newest)}
        for number, keyframe in enumerate(graph.keyframes):
            found.get(graph.sessions.root(keyframe.session), []).append(number)
        return {(root, k): old[k : k + size] for root, old in found.items() for k in range(0, len(old), size)}

    def _tried(self, old: list[int]) -> Tried:
        settings, places = self.settings, [self._graph.keyframes[k] for k in old]
        recent = self._graph.last(settings.verification.beside)
        return relocalise(recent, places, settings.relocalisation, settings.verification)

    def _confirmed(self, fixed: int, alignment: Alignment, scans: tuple[int, int]) -> bool:
        graph = self._graph
        found = graph.recognised(fixed, alignment)
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
