"""Figures: every one is drawn with what it promises, also for a drive that found nothing."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from shapely import MultiPolygon, Polygon, box

from backend.room_map import Decision, Door, MapEdge, MapEdgeKind, Obstacle, RoomMap, Verdict
from frontend.scan import Scan, Sensor
from slam.figures.gallery import FIGURES, draw, draw_errors
from slam.figures.rooms import map_errors
from slam.perception import FrontendSettings, perceive
from slam.scores.maps import MapTruth
from slam.story import Story


def story(views: int) -> Story:
    bearings = np.radians(np.arange(-180.0, 180.0, 2.0))
    square = 2 / np.maximum(np.abs(np.cos(bearings)), np.abs(np.sin(bearings)))
    ranges = np.where(np.abs(bearings) < 0.2, np.inf, square)
    scan = Scan(bearings, ranges, Sensor("lidar", 5.0), np.zeros(3), 0.0)
    edges = (
        MapEdge((-2.0, -2.0), (2.0, -2.0), MapEdgeKind.REAL, 3, 0, 0.01, np.arange(3)),
        MapEdge((2.0, -2.0), (2.0, 2.0), MapEdgeKind.FRONTIER, 0, 0, np.inf, np.arange(0)),
    )
    room = RoomMap(
        MultiPolygon([Polygon(box(-2, -2, 2, 2).exterior, [box(0.5, 0.5, 1, 1).exterior])]),
        MultiPolygon([box(-1.9, -1.9, 1.9, 1.9)]),
        edges,
        (Door("east", np.array([[2.0, 0.0], [2.0, 0.9]]), 1.0, np.arange(1)),),
        (Obstacle(box(0.5, 0.5, 1, 1), False, 2, np.arange(2)), Obstacle(box(-1, -1, 0, 0), True, 0, np.arange(0))),
        np.empty((0, 2)),
        (
            Decision(Verdict.KEPT, np.array([[-2.0, -2.0], [2.0, -2.0]]), np.array([0]), np.arange(3)),
            Decision(Verdict.INFERRED, np.array([[-1.0, -1.0], [0.0, -1.0], [0.0, 0.0]]), np.arange(0), np.arange(2)),
        ),
    )
    poses = np.zeros((views, 3)) + 0.1 * np.arange(views)[:, None]
    paths = {"cones": np.array([[0.0, 0.0, 0.0], [1.5, 0.0, 0.0]])}
    return Story((perceive(scan, FrontendSettings()),) * views, poses, room, np.array([[-2.0, -2.0]]), paths)


def labels(figure: Figure) -> set[str]:
    legends = [axes.get_legend() for axes in figure.axes]
    return {text.get_text() for legend in legends if legend is not None for text in legend.get_texts()}


def test_every_figure_becomes_a_picture(tmp_path: Path) -> None:
    draw(story(5), tmp_path)
    assert {path.stem for path in tmp_path.iterdir()} == set(FIGURES) | {"8c_before_and_after", "8d_scale_space"}
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "promised"),
    [
        ("1_raw_boundaries", {"no return"}),
        ("2_redrawn_boundaries", {"surface", "no return, or inferred"}),
        ("3_sketches", {"line", "corner"}),
        ("5_map", {"wall", "frontier", "door", "obstacle", "inferred obstacle", "drive", "1 landmarks"}),
        ("4b_decisions", {"surface kept: 1", "object inferred: 1", "drive"}),
        ("6_paths", {"cones"}),
    ],
)
def test_a_figure_names_what_it_shows(name: str, promised: set[str]) -> None:
    assert promised <= labels(FIGURES[name](story(2)))


def test_the_error_picture_tells_false_free_ground_from_missed(tmp_path: Path) -> None:
    free = MultiPolygon([box(-2, -2, 3, 1.5)])
    truth = MapTruth(free, free, np.empty((0, 2, 2)), ())
    assert {"false free, 2.00 m²", "missed free, 3.75 m²"} <= labels(map_errors(story(1).room, truth))
    assert draw_errors(story(1).room, truth, tmp_path).read_bytes().startswith(b"\x89PNG")


def test_a_perfect_map_has_an_error_picture_without_errors() -> None:
    room = story(1).room
    truth = MapTruth(room.free, room.free, np.empty((0, 2, 2)), ())
    assert "false free, 0.00 m²" in labels(map_errors(room, truth))


def test_a_panel_for_each_of_few_views_and_three_for_many() -> None:
    assert [len(FIGURES["3_sketches"](story(views)).axes) for views in (1, 2, 9)] == [1, 2, 3]
