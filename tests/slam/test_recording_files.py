import gzip
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from frontend.scan import Scan
from frontend.sensors.sonar import SONAR
from slam.readers.range_table import parse_header, parse_row
from slam.readers.recording import OdometryNoise, RecordingError
from slam.recording_files import readings_csv, recording_toml, write_recording
from slam.whole_output import OutputError

SCAN = Scan(
    bearings=np.radians([-90.0, 0.0, 90.0]),
    ranges=np.array([1.25, np.inf, 3.0]),
    sensor=SONAR,
    odometry=np.array([0.1, 0.2, -0.3]),
    time=30.0,
    infrared=np.array([11, 30, 31], np.int16),
)


def test_a_reading_without_an_echo_is_an_empty_field() -> None:
    header, row = readings_csv([SCAN]).decode().splitlines()
    assert header == (
        "time,x,y,heading,range@-90.0000,range@0.0000,range@90.0000,infrared@-90.0000,infrared@0.0000,infrared@90.0000"
    )
    assert row == "30.000,0.100000,0.200000,-0.300000,1.2500,,3.0000,11,30,31"


def test_a_reading_that_failed_is_read_back_as_one() -> None:
    header, row = readings_csv([replace(SCAN, ranges=np.array([np.nan, np.inf, 3.0]))]).decode().splitlines()
    assert np.array_equal(parse_row(row, parse_header(header), SONAR).ranges, [np.nan, np.inf, 3.0], equal_nan=True)


def test_scans_that_do_not_share_their_bearings_are_refused() -> None:
    with pytest.raises(RecordingError, match="scan 2 has other bearings than the first"):
        readings_csv([SCAN, replace(SCAN, bearings=SCAN.bearings + 0.01)])


def test_a_long_recording_is_compressed_and_says_the_same() -> None:
    lines = gzip.decompress(readings_csv([SCAN] * 11)).decode().splitlines()
    assert lines == [*readings_csv([SCAN]).decode().splitlines(), *[readings_csv([SCAN]).decode().splitlines()[1]] * 10]


def test_the_facts_are_in_metres_and_degrees() -> None:
    about = {"name": "flynn_basement", "description": "", "command": 'roomsketch "quoted"'}
    facts = tomllib.loads(recording_toml(about, OdometryNoise(0.05, 0.05, 0.02), [SCAN]).decode())
    assert facts["name"] == "flynn_basement"
    assert facts["command"] == 'roomsketch "quoted"'
    assert facts["readings"] == "readings.csv"
    assert facts["sensor"]["half_beam_degrees"] == pytest.approx(np.degrees(SONAR.half_beam))
    assert facts["sensor"]["infrared_range"] == pytest.approx(3.048)
    assert facts["odometry"] == {"distance_noise": 0.05, "turn_noise": 0.05, "turn_per_metre_noise": 0.02}


def test_a_recording_replaces_an_older_one_and_nothing_else(tmp_path: Path) -> None:
    folder = tmp_path / "recording"
    write_recording(folder, {"recording.toml": b"1", "old": b""})
    write_recording(folder, {"recording.toml": b"2"})
    assert [file.name for file in folder.iterdir()] == ["recording.toml"]
    assert (folder / "recording.toml").read_bytes() == b"2"
    precious = tmp_path / "precious"
    precious.mkdir()
    (precious / "thesis.tex").write_text("")
    with pytest.raises(OutputError, match=r"precious holds other files and no recording.toml"):
        write_recording(precious, {"recording.toml": b""})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["precious", "recording"]


def test_a_failed_write_leaves_the_older_recording_and_no_rest(tmp_path: Path) -> None:
    folder = tmp_path / "recording"
    write_recording(folder, {"recording.toml": b"1"})
    with pytest.raises(OutputError, match="recording cannot be written: No such file"):
        write_recording(folder, {"recording.toml": b"2", "missing/readings.csv": b""})
    assert (folder / "recording.toml").read_bytes() == b"1"
    assert [path.name for path in tmp_path.iterdir()] == ["recording"]
