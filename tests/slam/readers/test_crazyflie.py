"""Crazyflie logs: four beams round the drone, trusted to two metres."""

from pathlib import Path

import numpy as np
import pytest

from slam.readers.crazyflie import COLUMNS, read_crazyflie
from slam.readers.recording import RecordingError


def test_four_beams_stand_right_front_left_and_back(tmp_path: Path) -> None:
    path = tmp_path / "flight.csv"
    path.write_text(f"{COLUMNS}\n1.0,0.5,0.6,0.3,0.1,1.1,2.5,1.3,1.4,2.3\n")
    flight = read_crazyflie(path, True)
    (scan,) = flight.scans
    seen = np.isfinite(scan.ranges)
    by_bearing = dict(zip(np.degrees(scan.bearings[seen]).round(), scan.ranges[seen], strict=True))
    assert len(by_bearing) == 3  # the front beam had no echo within two metres
    for bearing, measured in ((-90, 1.1), (90, 1.3), (180, 1.4)):
        apart = {abs((other - bearing + 180) % 360 - 180): value for other, value in by_bearing.items()}
        assert min(apart) <= 2
        assert apart[min(apart)] == pytest.approx(measured)
    assert np.array_equal(scan.odometry, [0.5, 0.6, 0.1])
    assert flight.odometry is not None
    assert np.array_equal(flight.odometry.poses, [[0.5, 0.6, 0.1]])


def test_a_line_cut_short_is_refused_with_its_number(tmp_path: Path) -> None:
    path = tmp_path / "flight.csv"
    path.write_text(f"{COLUMNS}\n1.0,0.5,0.6,0.3\n")
    with pytest.raises(RecordingError, match=r"flight\.csv line 2: 4 fields"):
        read_crazyflie(path, False)
