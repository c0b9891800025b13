"""The search for other sessions' places: two recognitions that agree join two frames, one joins nothing."""

import numpy as np

from frontend.registration import Alignment
from frontend.rigid_motion import between, compose
from frontend.scan import Floats
from slam.keyframes import Keyframe
from slam.logbook import Logbook
from slam.loops import Tried
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings, perceive
from slam.pose_graph import PoseGraph
from slam.relocalisation import RelocalisationSettings
from slam.session_search import SessionSearch
from tests.simulated_drives import drive, once_round, round_building

SETTINGS = MapperSettings(relocalisation=RelocalisationSettings(piece=4))
PERCEPT = perceive(drive(round_building(), once_round()[:1], seed=0)[0], FrontendSettings())
OLD = np.array([[float(x), 0.0, 0.0] for x in range(8)])  # where the first session's keyframes truly stand
NEW = np.array([[2.0, 1.0, 0.5], [3.0, 1.0, 0.5]])  # and the second one's
SURE = np.diag([0.01, 0.01, 0.005]) ** 2
NOWHERE = Tried(1, "no place for its surface")


def extended(graph: PoseGraph, true: Floats) -> None:
    """A session more, its keyframes at true poses (n, 3) seen from the first of them."""
    start = graph.begin_session(len(graph.keyframes), PERCEPT)
    for step in between_all(true):
        new = len(graph.keyframes)
        graph.factors.add_pose(new, compose(start, step))
        graph.factors.add_motion(new - 1, new, between(graph.keyframes[-1].pose, compose(start, step)), SURE)
        graph.add_keyframe(Keyframe(new, graph.sessions.newest, PERCEPT, compose(start, step)))
    graph.settle()


def between_all(true: Floats) -> list[Floats]:
    return [between(true[0], pose) for pose in true[1:]]


def two_sessions() -> PoseGraph:
    graph = PoseGraph(SETTINGS)
    extended(graph, OLD)
    extended(graph, NEW[:1])
    return graph


def recognised(fixed: int, true: Floats, shift: float = 0.0) -> Tried:
    """The newest keyframe, truly at `true` (3,), found by the surface around the fixed one of the first piece."""
    pose = true + np.array([shift, 0.0, 0.0])
    return Tried(fixed, Alignment(pose, np.asarray(np.linalg.inv(SURE)), np.empty((0, 2), np.int64), 0.01, 0.9, 0.5))


def search(graph: PoseGraph, *answers: Tried) -> SessionSearch:
    """A search that is answered so, one look after the other."""
    logbook = Logbook()
    for answer in answers:
        logbook.answer(lambda answer=answer: answer)  # type: ignore[misc]
    return SessionSearch(SETTINGS, graph, Logbook(logbook.lines))


def looked_until(places: SessionSearch, graph: PoseGraph, decisions: int) -> int:
    """Look until so many decisions were made; how often was looked."""
    looks = 0
    while len(graph.decisions) < decisions:
        places.join_sessions()
        looks += 1
        assert looks < 100
    return looks


def test_with_one_frame_nothing_is_looked_for() -> None:
    graph = PoseGraph(SETTINGS)
    extended(graph, OLD)
    assert not search(graph).join_sessions()
    assert not graph.decisions


def go_on(graph: PoseGraph) -> None:
    """The lost robot drives on to the second of its true poses."""
    step, new = between(NEW[0], NEW[1]), len(graph.keyframes)
    pose = compose(graph.keyframes[-1].pose, step)
    graph.factors.add_pose(new, pose)
    graph.factors.add_motion(new - 1, new, step, SURE)
    graph.add_keyframe(Keyframe(new, graph.sessions.newest, PERCEPT, pose))


def test_two_views_that_agree_lay_the_later_session_where_it_truly_was() -> None:
    graph = two_sessions()
    places = search(graph, recognised(2, NEW[0]), NOWHERE, recognised(3, NEW[1]))
    assert not places.join_sessions()
    assert graph.decisions[-1].reason == "90% matched, not yet said by another view"
    go_on(graph)
    looked_until(places, graph, 3)
    assert not graph.sessions.apart
    np.testing.assert_allclose(graph.keyframe_poses[-2:], NEW, atol=0.01)
    assert [(one.what, one.accepted) for one in graph.decisions] == [
        ("place", False),
        ("place", False),
        ("place", True),
    ]


def test_two_views_that_contradict_each_other_join_nothing() -> None:
    graph = two_sessions()
    places = search(graph, recognised(2, NEW[0], shift=2.0), NOWHERE, recognised(3, NEW[1]))
    places.join_sessions()
    go_on(graph)
    looked_until(places, graph, 3)
    assert graph.sessions.apart
    assert not any(one.accepted for one in graph.decisions)


def test_a_place_not_found_is_told_with_the_scans_and_the_reason() -> None:
    graph = two_sessions()
    assert not search(graph, NOWHERE).join_sessions()
    assert [(one.scans, one.reason) for one in graph.decisions] == [((1, 8), NOWHERE.found)]


def test_every_piece_of_an_old_map_gets_its_turn() -> None:
    graph = two_sessions()
    places = search(graph, *[NOWHERE] * 4)
    looked_until(places, graph, 4)
    assert [one.scans[0] for one in graph.decisions] == [1, 5, 1, 5]


def test_the_longer_in_vain_the_rarer_it_looks_until_a_session_begins() -> None:
    graph = two_sessions()
    places = search(graph, *[NOWHERE] * 42)
    early = looked_until(places, graph, 10)
    looked_until(places, graph, 30)
    late = looked_until(places, graph, 40)
    assert late > 1.5 * early
    places.begin_session()
    assert looked_until(places, graph, 41) == 1
