"""Constellations within a drive: a loop whose doubt no window covers is closed by corners, and by nothing less."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from backend.estimate import Estimate
from backend.loop_closure import Candidate
from frontend.corner_constellations import ConstellationSettings
from frontend.registration import Alignment
from frontend.rigid_motion import between
from slam.constellation_search import ConstellationSearch
from slam.doubted_loops import DoubtedLoops
from slam.keyframes import Keyframe
from slam.logbook import Logbook
from slam.loops import close_loop
from slam.mapper import Mapper
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings, perceive
from slam.pose_graph import PoseGraph
from slam.simulation.trajectory import WheelNoise
from tests.simulated_drives import corridor, drive, once_round, round_building

POSES = once_round(beyond=9.0)
BAD = WheelNoise(0.1, 0.05, 0.05)
RIVALS = {"another place holds the scan as well"}
# As in a building so large that no window covers the doubt of its end.
NO_WINDOW = replace(MapperSettings().loops, widest=0.01, confirmed=2.0)


@cache
def mapped(most: int) -> tuple[Mapper, Estimate]:
    settings = MapperSettings(loops=NO_WINDOW, constellations=ConstellationSettings(proposals=most, recent=20))
    mapper = Mapper(FrontendSettings(), settings)
    for scan in drive(round_building(), POSES, seed=3, wheels=BAD):
        mapper.add(scan)
    return mapper, mapper.result()


def test_a_round_is_closed_by_corners_where_no_window_is_wide_enough() -> None:
    _, estimate = mapped(3)
    closed = [one for one in estimate.decisions if one.what == "loop" and one.accepted]
    assert closed[0].reason == f"said again by scan {closed[1].scans[1]}"
    true = np.array([between(POSES[0], pose) for pose in POSES])
    assert np.linalg.norm(estimate.poses[-1, :2] - true[-1, :2]) < 0.05


def test_without_proposals_it_stays_open() -> None:
    """What a window too small found may confirm, but proposes nothing."""
    _, estimate = mapped(0)
    assert not any(one.what == "loop" and one.accepted for one in estimate.decisions)


def test_every_loop_that_was_believed_is_true() -> None:
    _, estimate = mapped(3)
    for one in estimate.decisions:
        if one.what == "loop" and one.accepted:
            first, last = one.scans
            off = between(POSES[first], POSES[last]) - between(estimate.poses[first], estimate.poses[last])
            assert np.hypot(*off[:2]) < 0.1


@pytest.mark.parametrize(("apart", "refused"), [(0.2, {"95% matched, not yet said by another view"}), (4.0, RIVALS)])
def test_a_view_that_two_places_hold_is_believed_at_none(
    apart: float, refused: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in a building of equal rooms, every place that is proposed holds."""

    def holds(*asked: Any) -> Alignment:
        return Alignment(asked[1], np.eye(3) * 1e4, np.empty((0, 2), np.int64), 0.01, 0.95, 0.5)

    graph, there = PoseGraph(MapperSettings()), np.array([1.0, 0.0, 0.0])
    graph.begin_session(0, perceive(drive(round_building(), POSES[:1], seed=3)[0], FrontendSettings()))
    proposed = [there, there + np.array([apart, 0.0, 0.0])]
    monkeypatch.setattr("slam.constellation_search.poses_of_corners", lambda *_: proposed)
    search = ConstellationSearch(MapperSettings(), DoubtedLoops(graph, NO_WINDOW, 0.05), Logbook(), holds)
    assert not search.find([Candidate(0, 20.0, 0.5, covered=False)])
    assert {one.reason for one in graph.decisions} == refused


def test_a_corridor_without_corners_proposes_nothing() -> None:
    rng_poses = np.column_stack([np.linspace(20, 30, 40), np.full(40, 1.0), np.zeros(40)])
    graph, settings = PoseGraph(MapperSettings()), MapperSettings()
    percepts = [perceive(scan, FrontendSettings()) for scan in drive(corridor(), rng_poses, seed=0)]
    graph.begin_session(0, percepts[0])
    for number, percept in enumerate(percepts[1:], 1):
        pose = between(rng_poses[0], rng_poses[number])
        graph.factors.add_pose(number, pose)
        graph.add_keyframe(Keyframe(number, 0, percept, pose))
        graph.see_landmarks()
    search = ConstellationSearch(settings, DoubtedLoops(graph, settings.loops, 0.05), Logbook(), close_loop)
    assert not search.find([Candidate(k, 20.0, 0.5, covered=False) for k in range(10)])
    assert not graph.decisions


def test_where_every_place_is_within_a_window_nobody_is_asked() -> None:
    logbook = Logbook()
    graph = PoseGraph(MapperSettings())
    search = ConstellationSearch(
        MapperSettings(), DoubtedLoops(graph, MapperSettings().loops, 0.05), logbook, close_loop
    )
    assert not search.find([])
    assert not logbook.lines
