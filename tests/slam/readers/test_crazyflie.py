"""Crazyflie logs: four beams round the drone, trusted to two metres."""

from pathlib import Path

import numpy as np
import pytest

from slam.readers.crazyflie import COLUMNS, read_crazyflie
from slam.readers.recording import RecordingError


def test_four_beams_stand_right_front_left_and_back(tmp_path: Path) -> None:
    path = tmp_path / "flight.csv"
    path.write_text(f"{COLUMNS}\n1.0,0.5,0.6,0.3,0.1,1.1,2.5,1.3,1.4,2.3\n")
    scan = read_crazyflie(path, True).scans[0]
    assert np.allclose(np.degrees(scan.bearings), [-90, 0, 90, 180])
    assert np.array_equal(scan.ranges, [1.1, np.inf, 1.3, 1.4])
    assert np.array_equal(scan.odometry, [0.5, 0.6, 0.1])


def test_a_line_cut_short_is_refused_with_its_number(tmp_path: Path) -> None:
    path = tmp_path / "flight.csv"
    path.write_text(f"{COLUMNS}\n1.0,0.5,0.6,0.3\n")
    with pytest.raises(RecordingError, match=r"flight\.csv line 2: 4 fields"):
        read_crazyflie(path, False)
