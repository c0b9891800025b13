"""Figures of plans show what each planner built, and its answer in the title."""

import numpy as np
from shapely import box

from planners.cells import EMPTY, FULL
from planners.path import Answer, Cells, Cone, Gap, Path
from planners.robot import Robot
from planners.world import World
from slam.figures.plans import draw_plans, png_of

WORLD = World.from_obstacles(box(0, 0, 6, 2), [])
ENDS = np.array([1.0, 1.0, 0.0]), np.array([5.0, 1.0, 0.0])
PATH = Path(np.stack(ENDS), 0.75, "")
SPINE = np.array([[0.5, 1.0], [5.5, 1.0]])
OUTLINE = np.array([[0.5, 0.0], [5.5, 0.0], [5.5, 2.0], [0.5, 2.0]])
CONE = Cone(SPINE, np.array([[[0.0, 2 * np.pi]]]), lambda: OUTLINE)
CELLS = Cells(np.array([[0.0, 0, 0], [5, 0, 0]]), np.array([[5.0, 2, 1], [6, 2, 1]]), np.array([EMPTY, FULL], np.int8))


def test_every_planner_has_a_panel_that_says_what_it_found() -> None:
    answers = {
        "cones": Answer("path", "", PATH, cones=(CONE,)),
        "configuration-space": Answer("no path", "shut", cells=CELLS),
    }
    figure = draw_plans(answers, WORLD, Robot.rectangle(1.0, 0.5), ENDS)
    first, second = figure.axes
    assert first.get_title() == "cones: 4.00 m, clearance 0.750 m"
    assert second.get_title() == "configuration-space: no path"
    assert "1 spines" in first.get_legend_handles_labels()[1]
    assert {"1 boxes free", "1 boxes colliding throughout"} <= set(second.get_legend_handles_labels()[1])
    assert png_of(figure).startswith(b"\x89PNG")


def test_the_gap_of_a_proof_is_marked_where_it_is() -> None:
    gap = Gap(np.array([[[0.0, 0], [6, 0]], [[0, 2], [6, 2]]]), 2.0, 2.5, np.array([3.0, 1.0]))
    axes = draw_plans({"configuration-space": Answer("no path", "", gap=gap)}, WORLD, Robot.disc(1.25), ENDS).axes[0]
    assert "2 m wide, 2.5 m needed" in axes.get_legend_handles_labels()[1]
    assert any(np.allclose(line.get_xydata(), [[3.0, 1.0]]) for line in axes.lines)
