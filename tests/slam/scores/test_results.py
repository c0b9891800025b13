"""Scoring: what was visible, what the raw readings claim, and errors that a known displacement must give."""

from pathlib import Path

import numpy as np
import pytest
from shapely import MultiPolygon, Polygon, box

from frontend.scan import Scan, Sensor
from slam.result_folder import ODOMETRY, TRAJECTORY
from slam.scores.results import overlap, pose_scores, raw_free_space, relation_scores, scaled_to, visible
from slam.trajectory_file import TrajectoryFileError, tum_text

ROOM = MultiPolygon([Polygon(box(-2, -2, 2, 2).exterior, [box(1, -1, 1.2, 1).exterior])])
TIMES = np.arange(5.0)
DRIVE = np.column_stack([TIMES, np.sin(TIMES), TIMES / 5])


def test_what_stands_behind_an_obstacle_is_not_visible() -> None:
    seen = visible(ROOM, np.zeros((1, 3)), 10.0)
    behind = box(1.2, -1, 1.9, 1)
    assert seen.intersection(behind).area < 1e-3
    assert seen.area == pytest.approx(16 - 3, rel=1e-3)  # the shadow is a trapezoid from 2 to 4 m wide, 1 m deep
    assert visible(ROOM, np.zeros((1, 3)), 0.5).area == pytest.approx(np.pi * 0.25, rel=1e-3)


def test_raw_readings_claim_what_they_say_where_they_stood() -> None:
    bearings = np.radians(np.arange(-180.0, 180.0))
    scan = Scan(bearings, np.where(bearings > 3, np.inf, 1.0), Sensor("lidar", 1.0), np.zeros(3), 0.0)
    circle = raw_free_space((scan,), np.array([[5.0, 0.0, 1.0]]))
    assert circle.area == pytest.approx(np.pi, rel=1e-3)
    assert circle.centroid.x == pytest.approx(5.0)


def test_overlap_is_symmetric_and_one_only_for_equals() -> None:
    left, right = box(0, 0, 2, 1), box(1, 0, 3, 1)
    assert overlap(left, right) == overlap(right, left) == pytest.approx(1 / 3)
    assert overlap(left, left) == 1


def result(folder: Path) -> Path:
    (folder / TRAJECTORY).write_text(tum_text(TIMES, DRIVE))
    (folder / ODOMETRY).write_text(tum_text(TIMES, DRIVE * [1.1, 1.1, 1.0]))
    return folder


def test_a_rigidly_moved_truth_is_no_error_but_the_odometry_is_judged_beside(tmp_path: Path) -> None:
    turn = np.array([[0, -1], [1, 0]])
    moved = np.column_stack([DRIVE[:, :2] @ turn.T + [3, 4], DRIVE[:, 2] + np.pi / 2])
    (tmp_path / "true.tum").write_text(tum_text(TIMES, moved))
    scores = pose_scores(result(tmp_path), tmp_path / "true.tum")
    assert scores["position"]["worst"] < 1e-5
    assert scores["step"]["worst"] < 1e-5
    assert scores["position by odometry alone"]["rmse"] > 0.05


def test_a_camera_with_a_wrong_scale_is_told_apart_from_a_wrong_drive(tmp_path: Path) -> None:
    lines = [f"P {1000 * t:.0f} {1050 * x:.3f} {1050 * y:.3f}\n" for t, (x, y, _) in zip(TIMES, DRIVE, strict=True)]
    (tmp_path / "camera.txt").write_text("".join(lines))
    scores = pose_scores(result(tmp_path), tmp_path / "camera.txt")
    assert scores["position"]["rmse"] > 0.05
    assert scores["position, scale undone"]["rmse"] < 1e-4
    assert "turn" not in scores


def test_undoing_the_scale_leaves_the_right_scale_alone() -> None:
    assert np.allclose(scaled_to(DRIVE[:, :2], DRIVE[:, :2] + [1, 2]), DRIVE[:, :2])


def test_poses_of_another_time_are_refused(tmp_path: Path) -> None:
    (tmp_path / "true.tum").write_text(tum_text(TIMES + 100, DRIVE))
    with pytest.raises(TrajectoryFileError, match="0 poses lie in the time of the run"):
        pose_scores(result(tmp_path), tmp_path / "true.tum")


def test_relations_of_the_drive_itself_are_met(tmp_path: Path) -> None:
    (tmp_path / "a.relations").write_text("0 1 1 0.84147098 0 0 0 0.2\n")
    scores = relation_scores(result(tmp_path), tmp_path / "a.relations")
    assert scores["translation"]["mean"] < 1e-5
    assert scores["translation by odometry alone"]["mean"] == pytest.approx(np.hypot(1, 0.8415) * 0.1, rel=1e-3)
