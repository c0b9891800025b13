"""What is asked of a planner, and what is refused before one is loaded."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from shapely import box
from shapely.geometry import mapping

from planners.path import PlanningError
from planners.robot import RobotError
from slam.commands.plan import PlannerName
from slam.plan_question import CELLS, CONES, parse_pose, question_of
from slam.planning import PLANNERS
from slam.room_file import RoomFileError

ASKED = """
import sys
from slam.cli import main
sys.argv = ["roomsketch", "plan", *sys.argv[1:], "--planner", "cones"]
try:
    main()
finally:
    print(sorted({"gtsam", "numba", "matplotlib", "scipy"} & set(sys.modules)))
"""


@pytest.fixture
def room(tmp_path: Path) -> Path:
    place = tmp_path / "room.geojson"
    feature = {"type": "Feature", "geometry": mapping(box(0, 0, 4, 3)), "properties": {"kind": "free"}}
    place.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
    return place


def test_words_become_a_world_a_robot_and_two_poses(room: Path) -> None:
    question = question_of(room, "safety", 0.0, "disc:0.5", ("1,1", "3,2,0.5"))
    assert question.robot.radius == 0.5
    assert question.source.taken == "free"
    assert np.array_equal(question.ends, [[1, 1, np.nan], [3, 2, 0.5]], equal_nan=True)


def test_what_is_wrong_with_a_question_is_told_when_it_is_put(room: Path) -> None:
    with pytest.raises(RobotError, match="names no robot"):
        question_of(room, "safety", 0.0, "cube:1", ("1,1", "3,2"))
    with pytest.raises(PlanningError, match=r"goal \(3.8, 2\) has 0.2 m"):
        question_of(room, "safety", 0.0, "disc:0.5", ("1,1", "3.8,2"))
    with pytest.raises(RoomFileError, match="cannot be read"):
        question_of(room / "attic", "safety", 0.0, "disc:0.5", ("1,1", "3,2"))


@pytest.mark.parametrize(
    "asked",
    [
        ["--help"],
        ["--from", "1,1", "--to", "3,2", "--robot", "cube:3"],
        ["--from", "9,1", "--to", "3,2", "--robot", "disc:1"],
    ],
)
def test_who_asks_amiss_or_for_help_waits_for_no_planner(room: Path, asked: list[str]) -> None:
    told = subprocess.run([sys.executable, "-c", ASKED, str(room), *asked], capture_output=True, text=True, check=False)
    assert told.stdout.splitlines()[-1] == "[]"


def test_every_planner_can_be_asked_by_name() -> None:
    assert set(PlannerName) == {CONES, CELLS, "both"} == {*PLANNERS, "both"}


def test_a_pose_without_heading_leaves_it_open() -> None:
    assert np.array_equal(parse_pose("1,-2.5"), [1, -2.5, np.nan], equal_nan=True)
    assert np.array_equal(parse_pose("1,-2.5,0.5"), [1, -2.5, 0.5])


@pytest.mark.parametrize("text", ["", "1", "1,2,3,4", "1;2", "nan,1", "inf,1"])
def test_what_is_no_pose_is_refused(text: str) -> None:
    with pytest.raises(PlanningError, match="X,Y"):
        parse_pose(text)
