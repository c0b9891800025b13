"""A lone range table: its farthest echo stands for the sensor's reach."""

from pathlib import Path

import pytest

from slam.readers.ranges_csv import read_ranges_csv
from slam.readers.recording import RecordingError


def test_the_farthest_echo_bounds_the_sensor(tmp_path: Path) -> None:
    path = tmp_path / "hall.csv"
    path.write_text("time,x,y,heading,range@0,range@1\n0,0,0,0,4.5,inf\n1,0,0,0,2,\n")
    recording = read_ranges_csv(path, True)
    assert recording.scans[0].sensor.max_range == 4.5
    assert recording.name == "hall"


def test_a_table_without_any_echo_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "void.csv"
    path.write_text("time,x,y,heading,range@0\n0,0,0,0,\n")
    with pytest.raises(RecordingError, match="not one echo in 1 scans"):
        read_ranges_csv(path, False)
