"""Boundary scores: surfaces against true ones, and walls that no longer stand, in two rooms beside each other."""

import numpy as np
import pytest
import shapely
from shapely import box

from slam.scores.boundaries import MapScoreError, boundary_scores, corners, edges_of, samples, wall_breach

FREE = shapely.union_all([box(0, 0, 3, 4), box(3.1, 0, 6, 4), box(3, 1.5, 3.1, 2.4)])


def test_a_wall_eaten_from_one_side_is_not_breached() -> None:
    assert wall_breach(FREE.union(box(3, 0, 3.06, 4)), FREE) == 0


def test_a_breach_is_the_share_of_the_wall_that_is_gone() -> None:
    gone = FREE.union(box(2.9, 2.4, 3.2, 3.2))
    assert wall_breach(gone, FREE) == pytest.approx(0.8 / (4 - 0.9), abs=0.05)


def test_surfaces_off_by_seven_centimetres_are_right_within_ten_and_not_within_five() -> None:
    claimed = edges_of(FREE.buffer(-0.07, join_style="mitre"))
    scores = boundary_scores(claimed, edges_of(FREE), FREE)
    assert scores.precision_5cm < 0.1
    assert scores.recall_10cm > 0.95
    assert scores.chamfer == pytest.approx(0.07, abs=0.01)


def test_a_turned_map_is_off_by_its_angle() -> None:
    edges, turn = edges_of(FREE), 0.01
    turned = edges @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    assert boundary_scores(turned, edges, FREE).angle_error == pytest.approx(turn, rel=0.05)


def test_samples_lie_evenly_within_their_edge() -> None:
    points = samples(np.array([[[0.0, 0.0], [1.0, 0.0]], [[0.0, 5.0], [0.0, 5.004]]]), 0.1)
    np.testing.assert_allclose(points, [*[[0.05 + 0.1 * k, 0.0] for k in range(10)], [0.0, 5.002]], atol=1e-12)


def test_a_square_has_four_corners_and_a_fine_circle_none() -> None:
    assert len(corners(edges_of(box(0, 0, 1, 1)))) == 4
    assert len(corners(edges_of(shapely.Point(0, 0).buffer(1)))) == 0


def test_a_map_without_surfaces_cannot_be_scored() -> None:
    with pytest.raises(MapScoreError, match="no surface"):
        boundary_scores(np.empty((0, 2, 2)), edges_of(FREE), FREE)
