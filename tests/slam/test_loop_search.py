"""The search for loops: asked now and then, of places the doubt allows, and every answer is kept with its reason."""

from dataclasses import replace

import numpy as np
import pytest

from backend.loop_closure import Candidate
from frontend.local_map import Faces
from frontend.registration import Alignment
from frontend.rigid_motion import compose
from frontend.scan import Floats
from slam.doubted_loops import DoubtedLoops
from slam.keyframes import Keyframe
from slam.logbook import Logbook
from slam.loop_search import LoopSearch
from slam.loops import VerificationSettings
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings, Percept, perceive
from slam.pose_graph import PoseGraph
from tests.simulated_drives import drive, once_round, round_building

SETTINGS = MapperSettings()
SCAN = drive(round_building(), once_round()[:1], seed=0)[0]
PERCEPT = perceive(SCAN, FrontendSettings())
BLIND = perceive(replace(SCAN, ranges=np.full(SCAN.ranges.size, np.inf)), FrontendSettings())
ROUND = 36  # keyframes of a full circle
WIDE = Candidate(5, 6.0, 0.6, covered=False)
SURE = np.diag([0.02, 0.02, 0.005]) ** 2


def ring(count: int, first: Percept = PERCEPT) -> PoseGraph:
    """Keyframes on a circle of 3 m radius; the first few see what `first` saw."""
    graph = PoseGraph(SETTINGS)
    graph.begin_session(0, first)
    turn = 2 * np.pi / ROUND
    step = np.array([3 * np.sin(turn), 3 * (1 - np.cos(turn)), turn])
    for new in range(1, count):
        pose = compose(graph.keyframes[-1].pose, step)
        graph.factors.add_pose(new, pose)
        graph.add_keyframe(Keyframe(new, 0, first if new < 5 else PERCEPT, pose))
        graph.drift.add(new - 1, new, SURE)
    return graph


class Answers:
    """Answers every question alike, with the pose asked about moved by `shift` (3,), or with a reason."""

    def __init__(self, shift: Floats | None) -> None:
        self.shift = shift
        self.windows: list[tuple[float, float]] = []

    def __call__(
        self,
        percept: Percept,
        pose: Floats,
        recent: Faces,
        old: Faces,
        window: tuple[float, float],
        settings: VerificationSettings,
    ) -> Alignment | str:
        assert percept is PERCEPT
        assert settings is SETTINGS.verification
        assert min(len(recent.points), len(old.points)) > 0
        self.windows.append(window)
        if self.shift is None:
            return "it does not look alike"
        information = np.asarray(np.linalg.inv(SURE))
        return Alignment(compose(pose, self.shift), information, np.empty((0, 2), np.int64), 0.012, 0.9, 0.5)


def search(graph: PoseGraph, answers: Answers, logbook: Logbook | None = None) -> LoopSearch:
    return LoopSearch(SETTINGS, graph, logbook or Logbook(), answers)


def test_loops_are_searched_when_the_way_or_the_turns_since_the_last_search_add_up() -> None:
    loops = search(ring(1), Answers(None))
    assert [loops.moved(np.array([0.4, 0, 0])) for _ in range(3)] == [False, False, True]
    loops.close_loops()
    assert [loops.moved(np.array([0, 0, turn])) for turn in (0.6, -0.6)] == [False, True]


def test_a_drive_that_never_came_back_asks_nothing() -> None:
    answers = Answers(np.zeros(3))
    assert not search(ring(ROUND // 2), answers).close_loops()
    assert not answers.windows


@pytest.mark.parametrize(("shift", "surprised"), [(0.02, False), (0.2, True)])
def test_a_place_found_again_is_tied_and_mends_the_graph_where_it_disagrees(shift: float, surprised: bool) -> None:
    graph, answers = ring(ROUND + 1), Answers(np.array([shift, 0, 0]))
    assert search(graph, answers).close_loops() is surprised
    fixed, moving = graph.factors.ties[0].fixed, graph.factors.ties[0].moving
    assert (fixed <= 6, moving) == (True, ROUND)
    accepted = graph.decisions[0]
    assert (accepted.what, accepted.scans, accepted.accepted) == ("loop", (fixed, moving), True)
    assert accepted.reason == f"90% matched, 1.2 cm rms, {shift:.2f} m from the graph"


def test_a_window_is_as_wide_as_the_doubt_of_the_way_round() -> None:
    answers = Answers(None)
    graph = ring(ROUND + 1)
    search(graph, answers).close_loops()
    doubt = graph.drift.place_from(ROUND, graph.keyframe_poses[:, :2]).max()
    assert 0.5 * doubt < answers.windows[0][0] / SETTINGS.loops.sigmas <= doubt


def test_a_place_that_does_not_look_alike_is_refused_with_the_reason_and_ties_nothing() -> None:
    graph = ring(ROUND + 1)
    assert not search(graph, Answers(None)).close_loops()
    assert {(one.accepted, one.reason) for one in graph.decisions} == {(False, "it does not look alike")}
    assert not graph.factors.ties


def test_a_place_of_which_nothing_was_seen_is_not_even_tried() -> None:
    graph, answers = ring(ROUND + 1, first=BLIND), Answers(np.zeros(3))
    assert not search(graph, answers).close_loops()
    assert "no surface of its own" in graph.decisions[0].reason
    assert all(tie.fixed >= 5 for tie in graph.factors.ties)


def test_a_run_that_goes_on_reads_the_answers_of_the_first_and_asks_nobody() -> None:
    first, again, logbook, answers = ring(ROUND + 1), ring(ROUND + 1), Logbook(), Answers(None)
    search(first, Answers(np.array([0.2, 0, 0])), logbook).close_loops()
    assert search(again, answers, Logbook(logbook.lines)).close_loops()
    assert again.decisions == first.decisions
    assert not answers.windows


def test_when_a_doubted_loop_solved_the_graph_what_was_found_before_is_not_tied_to_where_poses_are_now(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    graph = ring(ROUND)
    loops = search(graph, Answers(np.zeros(3)))
    monkeypatch.setattr("slam.loop_search.candidates", lambda *_: [WIDE, replace(WIDE, pose=6, covered=True)])
    monkeypatch.setattr(DoubtedLoops, "weigh", lambda *_, **__: True)
    assert loops.close_loops()
    assert not graph.factors.loop_residuals()
