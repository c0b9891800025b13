"""What is said when both planners answer one question."""

import numpy as np
import pytest
from shapely import box

from planners.path import Answer, Path
from planners.robot import Robot
from planners.world import World
from slam.planner_comparison import CELLS, CONES, Trial, compare, trial_values, verdict
from slam.planning import PlanningSettings

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


@pytest.mark.parametrize(("path", "why"), [(BENT, "turn while it moves"), (STRAIGHT, "leaves the middle")])
def test_a_way_that_spines_miss_is_explained_by_the_way_that_was_found(path: Path, why: str) -> None:
    told = said(Answer("not found", "headings lost"), Answer("path", "", path))
    assert why in told
    assert told.endswith("headings lost")


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
