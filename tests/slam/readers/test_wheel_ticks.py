"""Wheel ticks: arcs add up to the circle that was driven, and a scan takes the pose of its own moment."""

from pathlib import Path

import numpy as np
import pytest

from slam.readers.recording import RecordingError
from slam.readers.wheel_ticks import METRES_PER_TICK, WHEEL_BASE, dead_reckon, read_wheel_ticks


def test_a_circle_driven_in_arcs_of_any_length_closes() -> None:
    turn = np.linspace(0, 2 * np.pi, 7)
    travelled = np.column_stack([turn * (1.0 - WHEEL_BASE / 2), turn * (1.0 + WHEEL_BASE / 2)])
    poses = dead_reckon(travelled, WHEEL_BASE)
    assert np.allclose(poses[:, 2], turn)
    assert np.allclose(np.hypot(poses[:, 0], poses[:, 1] - 1.0), 1.0)


def write(folder: Path, motors: str, scans: str) -> Path:
    (folder / "arena_motors.txt").write_text(motors)
    (folder / "arena_scan.txt").write_text(scans)
    return folder


def test_a_scan_between_two_counts_gets_the_pose_between_them(tmp_path: Path) -> None:
    motors = "M 1000 0 0 0 0 0\nM 2000 100 0 0 0 100\nM 2000 200 0 0 0 200\n"
    recording = read_wheel_ticks(write(tmp_path, motors, "S 1500 3 15 500 1000\n"), True)
    scan = recording.scans[0]
    assert scan.odometry == pytest.approx([100 * METRES_PER_TICK, 0, 0])
    assert np.allclose(scan.ranges, [np.nan, 0.5, 1.0], equal_nan=True, atol=1e-3)
    assert scan.bearings[1] == pytest.approx(0.0, abs=1e-6)
    assert scan.time == 1.5


def test_a_scan_that_lost_ranges_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"arena_scan\.txt line 1: 2 ranges, but 3 are announced"):
        read_wheel_ticks(write(tmp_path, "M 1 0 0 0 0 0\nM 9 0 0 0 0 0\n", "S 5 3 500 1000\n"), True)


def test_motors_that_run_backward_in_time_are_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"arena_motors\.txt line 2: time 4 ms is before the last"):
        read_wheel_ticks(write(tmp_path, "M 5 0 0 0 0 0\nM 4 0 0 0 0 0\n", "S 5 1 500\n"), True)


def test_the_beams_share_the_field_of_view_about_the_middle_one(tmp_path: Path) -> None:
    standing = "M 0 0 0 0 0 0\nM 9000 0 0 0 0 0\n"
    scans = "".join(f"S {time} 660 {' '.join(['1000'] * 660)}\n" for time in (1000, 2000))
    bearings = read_wheel_ticks(write(tmp_path, standing, scans), True).scans[0].bearings
    assert bearings[330] == pytest.approx(0.0, abs=1e-6)
    assert np.degrees(bearings[-1] - bearings[0]) == pytest.approx(240 * 659 / 660, abs=1e-3)
