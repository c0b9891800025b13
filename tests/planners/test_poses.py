"""Where a robot can stand: free poses pass as they are, all others are refused with how far they are off."""

import numpy as np
import pytest

from planners.path import PlanningError
from planners.poses import standing
from planners.robot import Robot
from tests.planners.known_worlds import LONG, door

WORLD = door(9)


def test_a_free_pose_passes_with_its_heading_in_one_turn() -> None:
    assert np.allclose(standing(WORLD, LONG, [15, 30, -np.pi / 2], "start"), [15, 30, 1.5 * np.pi])


def test_a_free_heading_asks_for_the_reference_point_alone() -> None:
    assert np.isnan(standing(WORLD, LONG, [2, 30, None], "start")[2])


@pytest.mark.parametrize(
    ("robot", "pose", "says"),
    [
        (LONG, [15, 30], "start needs x, y and a heading"),
        (LONG, [15, np.inf, 0], "start needs x, y and a heading"),
        (
            LONG,
            [50, 10, 0],
            r"start \(50, 10\) lies 7 m outside of free space, where no wall encloses it",
        ),
        (LONG, [-4, 30, 0], r"start \(-4, 30\) lies 4 m outside of free space, where no wall encloses it"),
        (LONG, [7, 30, 0], "at 0° overlaps an obstacle: the robot reaches 3 m into it"),
        (Robot.disc(5), [3, 30, 0], "has 3 m to the nearest obstacle, but the robot needs 5"),
    ],
)
def test_what_cannot_stand_is_told_by_how_much(robot: Robot, pose: list[float], says: str) -> None:
    with pytest.raises(PlanningError, match=says):
        standing(WORLD, robot, pose, "start")
