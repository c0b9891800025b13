"""Object scores: doors paired by both jambs, and obstacles measured and inferred, each against what could be seen."""

import numpy as np
import pytest
import shapely
from shapely import Polygon, box

from backend.room_map import Door, Obstacle
from slam.scores.objects import door_scores, obstacle_scores

TABLE, GHOST = box(1, 2.5, 1.8, 3.2), box(4, 0.5, 4.5, 1)
FREE = shapely.union_all([box(0, 0, 3, 4), box(3.1, 0, 6, 4), box(3, 1.5, 3.1, 2.4)]).difference(TABLE)
JAMBS = np.array([[[3.05, 1.5], [3.05, 2.4]]])
NOBODY = np.empty(0, np.int64)


def door(jambs: list[list[float]]) -> Door:
    return Door("door", np.array(jambs), 1.0, NOBODY)


def thing(outline: Polygon, inferred: bool) -> Obstacle:
    return Obstacle(outline, inferred, 1, NOBODY)


def test_doors_are_paired_one_to_one_within_fifteen_centimetres() -> None:
    pair = (door([[3.05, 1.55], [3.05, 2.4]]), door([[3.05, 1.5], [3.05, 2.7]]))
    scores = door_scores(pair, JAMBS)
    assert (scores.precision, scores.recall) == (0.5, 1)
    assert scores.jamb_error == pytest.approx(0.025)
    assert scores.width_error == pytest.approx(0.05)


def test_which_jamb_is_told_first_does_not_matter() -> None:
    assert door_scores((door([[3.05, 2.4], [3.05, 1.5]]),), JAMBS).jamb_error == 0


def test_without_doors_nothing_is_right_or_wrong_of_those_claimed() -> None:
    scores = door_scores((), JAMBS)
    assert np.isnan([scores.precision, scores.jamb_error, scores.width_error]).all()
    assert scores.recall == 0


def test_inferred_and_measured_obstacles_are_scored_apart() -> None:
    scores = obstacle_scores((thing(TABLE, True), thing(GHOST, False)), (TABLE,), FREE, FREE)
    assert (scores.measured_precision, scores.inferred_precision) == (0, 1)
    assert (scores.measured_recall, scores.inferred_recall, scores.recall) == (0, 1, 1)


def test_of_a_body_seen_by_half_the_back_may_be_inferred_and_of_less_nothing_is_asked() -> None:
    behind, beside = box(1.0, 2.9, 1.8, 4), box(0.5, 2.4, 2.4, 4)
    for hidden, recall in ((behind, 1.0), (beside, np.nan)):
        scores = obstacle_scores((thing(TABLE, True),), (TABLE,), FREE, FREE.difference(hidden))
        assert np.isnan(scores.measured_recall)
        assert scores.inferred_recall == pytest.approx(recall, nan_ok=True)


def test_a_cupboard_against_a_wall_is_a_piece_of_the_wall() -> None:
    cupboard = box(0, 0, 0.6, 1)
    scores = obstacle_scores((), (TABLE, cupboard), FREE.difference(cupboard), FREE.difference(cupboard))
    assert scores.measured_recall == 0
    alone = obstacle_scores((), (cupboard,), FREE.difference(cupboard), FREE.difference(cupboard))
    assert np.isnan(alone.measured_recall)
