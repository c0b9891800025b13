import numpy as np
import pytest
import shapely

from planners.robot import CHORDS, Robot, RobotError, parse_robot
from planners.world import outside_arcs

ELL = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], dtype=float)


def test_sizes_are_read_from_words() -> None:
    assert parse_robot("disc:0.2").radius == 0.2
    assert parse_robot("rectangle:0.5x0.4").width == pytest.approx(0.4)


@pytest.mark.parametrize(
    "text", ["disc", "disc:0", "disc:1x2", "ball:3", "rectangle:2", "rectangle:2xwide", "disc:nan"]
)
def test_words_that_make_no_robot_are_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(RobotError, match=r"say|needs|has"):
        parse_robot(text)


def test_an_outline_that_is_not_convex_is_cut_into_parts_that_are() -> None:
    robot = Robot.polygons(ELL)
    assert shapely.union_all([shapely.Polygon(part) for part in robot.parts]).area == pytest.approx(3)
    assert robot.reach == pytest.approx(np.sqrt(5))


def test_an_outline_that_crosses_itself_is_refused() -> None:
    with pytest.raises(RobotError, match="crosses itself"):
        Robot.polygons(np.array([[0, 0], [1, 1], [1, 0], [0, 1]], dtype=float))


def test_symmetry_counts_the_headings_that_look_the_same() -> None:
    assert Robot.rectangle(2, 1).symmetry == 2
    assert Robot.rectangle(1, 1).symmetry == 4
    assert Robot.polygons(ELL).symmetry == 1


def test_width_is_the_narrowest_straight_passage() -> None:
    triangle = Robot.polygons(np.array([[0, 0], [4, 0], [0, 3]], dtype=float))
    assert triangle.width == pytest.approx(12 / 5)


def test_a_grown_robot_holds_the_old_one_and_the_chords_can_be_put_outside() -> None:
    outer = Robot.rectangle(2, 1).grown(float(outside_arcs(0.5, CHORDS)))
    exact = shapely.box(-1, -0.5, 1, 0.5).buffer(0.5, quad_segs=256)
    assert shapely.Polygon(outer.parts[0]).contains(exact)


def test_the_disc_inside_is_as_wide_as_the_sides_leave_it_and_none_without_the_reference_point() -> None:
    assert Robot.rectangle(20, 8).inner == pytest.approx(4)
    assert Robot.disc(0.3).inner == pytest.approx(0.3)
    assert Robot.polygons(ELL + 10).inner == 0


def test_a_rounded_part_beside_the_reference_point_holds_only_the_disc_that_its_rim_leaves() -> None:
    part = np.array([[1.0, 0.0], [2.0, 0.0], [2.0, 0.1]])
    assert Robot((part,), 0.3).inner == 0
    assert Robot((part,), 1.2).inner == pytest.approx(0.2)
