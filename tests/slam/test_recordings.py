"""Opening a recording: formats are told apart by what lies there; real logs of each kind are read whole."""

import os
from pathlib import Path

import numpy as np
import pytest

from slam.readers.crazyflie import COLUMNS
from slam.readers.recording import RecordingError
from slam.recordings import guess_format, open_recording

REAL = os.environ.get("ROOMSKETCH_DATA")
with_real_logs = pytest.mark.skipif(REAL is None, reason="ROOMSKETCH_DATA names no folder of real recordings")


@pytest.mark.parametrize(
    ("name", "content", "expected"),
    [
        ("a.log", "", "carmen"),
        ("a.csv", f"{COLUMNS}\n", "crazyflie"),
        ("a.csv", "time,x,y,heading\n", "ranges-csv"),
        ("recording.toml", "", "recording"),
        ("a_motors.txt", "", "wheel-ticks"),
    ],
)
def test_the_format_is_guessed(tmp_path: Path, name: str, content: str, expected: str) -> None:
    (tmp_path / name).write_text(content)
    folder = expected in {"recording", "wheel-ticks"}
    assert guess_format(tmp_path if folder else tmp_path / name) == expected


def test_what_cannot_be_guessed_is_said(tmp_path: Path) -> None:
    (tmp_path / "a.bag").write_text("")
    with pytest.raises(RecordingError, match="name it with --format, one of recording, carmen"):
        open_recording(tmp_path / "a.bag")
    with pytest.raises(RecordingError, match=r"holds neither recording\.toml nor"):
        open_recording(tmp_path)
    with pytest.raises(RecordingError, match="does not exist"):
        open_recording(tmp_path / "b.log")
    with pytest.raises(RecordingError, match="unknown format 'bag'"):
        open_recording(tmp_path / "a.bag", "bag")


@with_real_logs
@pytest.mark.parametrize(
    ("path", "scans", "beams", "no_return", "max_range"),
    [
        ("intel/intel.log.gz", 910, 180, 4172, 81.83),
        ("aces/aces.log.gz", 440, 180, 620, 50.0),
        ("lego_arena", 278, 660, 0, 4.0),
        ("crazyflie_corridor/olsson-demo.csv", 3431, 4, 5857, 2.0),
    ],
)
def test_real_logs_are_read_whole(path: str, scans: int, beams: int, no_return: int, max_range: float) -> None:
    recording = open_recording(Path(REAL or "") / path, strict=path != "lego_arena")
    assert len(recording.scans) == scans
    assert recording.damaged == ()
    assert {scan.ranges.size for scan in recording.scans} == {beams}
    assert sum(int(np.isinf(scan.ranges).sum()) for scan in recording.scans) == no_return
    assert recording.scans[0].sensor.max_range == max_range
