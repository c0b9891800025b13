"""The paper's story through the command line: three scans of a basement become a scored map with planned paths."""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, box
from shapely.affinity import rotate, translate

from frontend.scan import Floats
from slam.result_folder import story_of
from slam.room_file import free_space, read_room
from slam.trajectory_file import read_trajectory
from tests.stories.command_line import run

BASEMENT = Path(__file__).parents[2] / "datasets" / "flynn_basement"


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("basement") / "run"
    assert run("merge", BASEMENT, "--out", folder).code == 0
    return folder


def swept(poses: Floats, length: float, width: float) -> shapely.Geometry:
    """The ground a rectangle covers on its way through poses (p, 3), in steps of a centimetre or a degree."""
    grounds = []
    for start, end in pairwise(poses):
        move = end - start
        move[2] = np.arctan2(np.sin(move[2]), np.cos(move[2]))
        steps = int(max(np.hypot(*move[:2]) / 0.01, abs(move[2]) / np.radians(1))) + 1
        for x, y, heading in start + np.linspace(0, 1, steps + 1)[:, None] * move:
            body = rotate(box(-length / 2, -width / 2, length / 2, width / 2), heading, (0, 0), use_radians=True)
            grounds.append(translate(body, x, y))
    return shapely.union_all(grounds)


def true_free_space() -> MultiPolygon:
    return free_space(BASEMENT / "truth.geojson", "free")[0]


def test_a_result_holds_map_trajectory_report_settings_and_figures(result: Path) -> None:
    assert {path.name for path in result.iterdir()} == {
        "map.geojson", "decisions.geojson", "trajectory.tum", "odometry.tum", "graph.g2o",
        "report.json", "report.html", "settings.toml", "figures",
    }  # fmt: skip
    assert len(list((result / "figures").glob("*.png"))) == 11
    assert len(read_trajectory(result / "trajectory.tum").times) == 3
    assert read_room(result / "map.geojson").free.area > 10
    report = json.loads((result / "report.json").read_text())
    assert report["counts"]["scans"] == 3
    assert report["timings"]["merging"] > 0


def test_the_map_beats_the_raw_boundaries_and_the_scores_are_kept(result: Path) -> None:
    told = run("score", result, "--truth", BASEMENT / "truth.geojson", "--poses", BASEMENT / "true.tum", "--json")
    scores = json.loads(told.out)
    assert scores["map"]["iou"] > scores["raw boundaries"]["iou"]
    assert scores["map"]["wall_breach"] < 0.03
    assert scores["poses"]["position"]["rmse"] < 0.05
    assert json.loads((result / "report.json").read_text())["scores"]["map"] == scores["map"]
    assert (result / "figures" / "7_errors.png").exists()


def test_a_score_that_cannot_be_is_told_in_words(result: Path) -> None:
    told = run("score", result, "--truth", BASEMENT / "truth.geojson", "--poses", BASEMENT / "true.tum")
    assert "none in truth" in told.out
    assert "nan" not in told.out


@pytest.mark.parametrize("planner", ["cones", "configuration-space"])
def test_both_planners_find_a_path_on_the_map(result: Path, tmp_path: Path, planner: str) -> None:
    drive = ["--from", "0,0", "--to", "1.5,-2.5", "--robot", "rectangle:0.3x0.2", "--planner", planner]
    told = run("plan", result / "map.geojson", *drive, "--json", "--out", tmp_path / "path.geojson")
    answer = json.loads(told.out)
    assert told.code == 0
    assert answer["answer"] == "path"
    assert answer["layer"] == "safety"
    assert answer["length"] >= 2.9
    assert len(answer["poses"]) >= 2
    line = json.loads((tmp_path / "path.geojson").read_text())["features"][0]
    assert line["properties"]["length"] == pytest.approx(answer["length"])
    assert shapely.within(swept(np.array(answer["poses"]), 0.3, 0.2), true_free_space())


def test_no_path_is_no_error_but_no_success_either(result: Path) -> None:
    drive = ["--from", "0,0", "--to", "1.5,-2.5", "--robot", "rectangle:2.2x2.2", "--planner", "configuration-space"]
    told = run("plan", result / "map.geojson", *drive)
    assert told.code in {1, 3}
    assert not told.out or told.out.startswith(("no path", "undecided"))


def test_the_figures_can_be_drawn_again_from_the_folder(result: Path) -> None:
    for figure in (result / "figures").iterdir():
        figure.unlink()
    assert run("draw", result).code == 0
    assert len(list((result / "figures").glob("*.png"))) == 11
    assert len(story_of(result).percepts) == 3


def test_the_settings_of_a_run_repeat_it(result: Path, tmp_path: Path) -> None:
    told = run("merge", BASEMENT, "--out", tmp_path / "again", "--settings", result / "settings.toml")
    assert told.code == 0
    for name in ("map.geojson", "trajectory.tum", "settings.toml"):
        assert (tmp_path / "again" / name).read_text() == (result / name).read_text()
