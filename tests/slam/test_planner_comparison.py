"""What is said when both planners answer one question."""

import re

import numpy as np
import pytest
from shapely import box

from frontend.scan import Floats
from planners.path import Answer, Path
from planners.robot import Robot
from planners.world import World
from slam.plan_question import CELLS, CONES
from slam.planner_comparison import Trial, compare, trial, trial_values, verdict
from slam.planning import PlanningSettings
from tests.planners.known_worlds import LONG, corner, corner_query, diagonal

ROBOT = Robot.rectangle(1.0, 0.5)
STRAIGHT = Path(np.array([[0, 0, 0], [4, 0, 0.0]]), 0.2, "")
BENT = Path(np.array([[0, 0, 0], [4, 0, 1.0], [4, 1, 1.0]]), 0.5, "")


def said(cones: Answer, cells: Answer) -> str:
    return verdict({CONES: Trial(cones, 0.1), CELLS: Trial(cells, 0.2)}, ROBOT)


def test_two_paths_are_told_apart_by_length_and_clearance() -> None:
    told = said(Answer("path", "", BENT), Answer("path", "", STRAIGHT))
    assert told == f"{CONES} goes 25 % farther than {CELLS} and keeps 0.300 m more clearance"
    told = said(Answer("path", "", STRAIGHT), Answer("path", "", BENT))
    assert told == f"{CONES} goes 20 % less far than {CELLS} and keeps 0.300 m less clearance"


def test_who_stays_where_it_is_goes_no_share_of_nothing() -> None:
    turn = Path(np.array([[0, 0, 0], [0, 0, 1.0]]), 0.5, "")
    told = said(Answer("path", "", turn), Answer("path", "", turn))
    assert told == f"{CONES}, like {CELLS}, stays where it is and keeps 0.000 m more clearance"
    told = said(Answer("path", "", STRAIGHT), Answer("path", "", turn))
    assert told.startswith(f"{CONES} goes 4.000 m where {CELLS} stays in its place and keeps")


def only_cells_find(world: World, robot: Robot, *ends: Floats) -> str:
    """What is said of a question that cones do not answer."""
    trials = {name: trial(name, world, robot, (ends[0], ends[1]), PlanningSettings()) for name in (CONES, CELLS)}
    assert (trials[CONES].answer.kind, trials[CELLS].answer.kind) == ("not found", "path")
    return verdict(trials, robot)


def test_a_heading_that_the_slices_of_a_bend_lose_is_named_with_place_and_width() -> None:
    told = only_cells_find(corner(13), LONG, *corner_query(13))
    found = re.search(r"at \((.*), (.*)\) it holds the heading (\d+)°.* 13.00 m wide, loses .* (\d+)° to (\d+)°", told)
    assert found is not None
    x, y, heading, low, high = map(float, found.groups())
    assert x > 47 or y < 13, "in the bend"
    assert low < heading < high


@pytest.mark.parametrize(
    ("radius", "says"),
    [
        (2.5, r"it passes \((2[89]|3[012])\.\d\d, (2[89]|3[012])\.\d\d\), which none of the \d+ cones covers"),
        (1.0, "slices keep its headings all along, but no crossings or ways in join them"),
    ],
)
def test_a_way_across_corners_is_beside_all_cones_or_where_none_cross(radius: float, says: str) -> None:
    told = only_cells_find(diagonal(), Robot.disc(radius), np.array([10, 56, np.nan]), np.array([56, 10, np.nan]))
    assert re.search(says, told), told


@pytest.mark.parametrize(
    ("cones", "cells", "says"),
    [
        (Answer("path", "", BENT), Answer("undecided", "too fine"), "cannot tell at its resolution: too fine"),
        (Answer("not found", ""), Answer("no path", ""), "no planner finds a path for a robot 0.5 m wide"),
        (Answer("not found", ""), Answer("undecided", ""), "none is ruled out"),
    ],
)
def test_only_a_proof_rules_a_path_out(cones: Answer, cells: Answer, says: str) -> None:
    assert says in said(cones, cells)


def test_both_planners_are_asked_and_their_seconds_are_written() -> None:
    ends = np.array([1.0, 1.0, 0.0]), np.array([5.0, 1.0, 0.0])
    trials = compare(World.from_obstacles(box(0, 0, 6, 2), []), Robot.disc(0.3), ends, PlanningSettings())
    assert list(trials) == [CONES, CELLS]
    for values in map(trial_values, trials.values()):
        assert values["length"] == pytest.approx(4, rel=1e-6)
        assert values["seconds"] >= 0


def test_without_a_path_there_is_no_turning() -> None:
    assert trial_values(Trial(Answer("no path", "shut"), 0.1))["turning"] is None
