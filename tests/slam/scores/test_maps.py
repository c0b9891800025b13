"""Claims about the map scores, on maps whose errors are known by construction."""

import numpy as np
import pytest
import shapely
from shapely import Polygon, box
from shapely.geometry.base import BaseGeometry

from backend.contours import as_polygons
from backend.room_map import Door, MapEdge, MapEdgeKind, Obstacle, RoomMap
from slam.scores.boundaries import edges_of
from slam.scores.maps import MapTruth, best_alignment, moved, score_map

LEFT, RIGHT, GAP = box(0, 0, 3, 4), box(3.1, 0, 6, 4), box(3, 1.5, 3.1, 2.4)
TABLE = box(1, 2.5, 1.8, 3.2)
FREE = shapely.union_all([LEFT, RIGHT, GAP]).difference(TABLE)
JAMBS = np.array([[[3.05, 1.5], [3.05, 2.4]]])
TRUTH = MapTruth(FREE, FREE, JAMBS, (TABLE,))


def map_of(free: BaseGeometry, doors: tuple[Door, ...] = (), things: tuple[Obstacle, ...] = ()) -> RoomMap:
    whole = as_polygons(free)
    none = np.empty(0, dtype=np.int64)
    edges = tuple(
        MapEdge((float(a[0]), float(a[1])), (float(b[0]), float(b[1])), MapEdgeKind.REAL, 1, 0, 0.0, none)
        for a, b in edges_of(whole)
    )
    return RoomMap(whole, whole, edges, doors, things, np.empty((0, 2)))


def door(jambs: list[list[float]]) -> Door:
    return Door("door", np.array(jambs), 1.0, np.empty(0, dtype=np.int64))


def thing(outline: Polygon, inferred: bool) -> Obstacle:
    return Obstacle(outline, inferred, 1, np.empty(0, dtype=np.int64))


def test_the_truth_itself_scores_full_marks() -> None:
    scores = score_map(map_of(FREE, (door([[3.05, 2.4], [3.05, 1.5]]),), (thing(TABLE, False),)), TRUTH)
    assert scores.iou == pytest.approx(1)
    assert scores.wall_breach == 0
    assert scores.boundary.f1_5cm == pytest.approx(1)
    assert scores.boundary.chamfer == pytest.approx(0, abs=1e-9)
    assert scores.boundary.angle_error == pytest.approx(0, abs=1e-9)
    assert scores.boundary.corner_precision == scores.boundary.corner_recall == 1
    assert (scores.doors.precision, scores.doors.recall, scores.doors.jamb_error) == (1, 1, 0)
    assert scores.obstacles.measured_precision == scores.obstacles.recall == 1
    assert scores.components == scores.true_components == 1


def test_a_missing_wall_is_breached_although_the_overlap_hardly_shows_it() -> None:
    scores = score_map(map_of(box(0, 0, 6, 4).difference(TABLE)), TRUTH)
    assert scores.iou > 0.98
    assert scores.wall_breach > 0.9
    assert scores.false_free == pytest.approx(3.1 * 0.1, rel=1e-6)


def test_a_closed_door_splits_the_free_space_in_two() -> None:
    scores = score_map(map_of(FREE.difference(GAP)), TRUTH)
    assert (scores.components, scores.true_components) == (2, 1)
    assert scores.doors.recall == 0
    assert np.isnan(scores.doors.precision)


def test_a_shifted_map_falls_out_of_tolerance_and_alignment_brings_it_back() -> None:
    shifted = moved(map_of(FREE), np.array([0.06, -0.07, 0.01]))
    assert score_map(shifted, TRUTH).boundary.f1_5cm < 0.8
    back = moved(shifted, best_alignment(shifted, TRUTH))
    assert score_map(back, TRUTH).boundary.chamfer < 0.002


def test_only_what_could_be_seen_counts_as_missed() -> None:
    half = MapTruth(FREE, LEFT.difference(TABLE), JAMBS, (TABLE,))
    scores = score_map(map_of(LEFT.difference(TABLE)), half)
    assert scores.missed_free == 0
    assert scores.boundary.recall_5cm == pytest.approx(1, abs=0.01)
