"""Opening a recording: formats are told apart by what lies there; real logs of each kind are read whole."""

import os
import zipfile
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
        ("a.txt", "time,x,y,heading\n", "ranges-csv"),
        ("a.csv", "\ufefftime;x;y;heading\n", "ranges-csv"),
        ("a.csv", '"time","x"\n', "ranges-csv"),
        ("a.g2o", "", "carmen"),
        ("a.bag", "", "ros-bag"),
        ("a.mcap", "", "ros-bag"),
        ("metadata.yaml", "", "ros-bag"),
        ("recording.toml", "", "recording"),
        ("a_motors.txt", "", "wheel-ticks"),
    ],
)
def test_the_format_is_guessed(tmp_path: Path, name: str, content: str, expected: str) -> None:
    (tmp_path / name).write_text(content)
    folder = name in {"recording.toml", "a_motors.txt", "metadata.yaml"}
    assert guess_format(tmp_path if folder else tmp_path / name) == expected


def test_what_cannot_be_guessed_is_said(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("distance;angle\n")
    with pytest.raises(
        RecordingError, match="begins 'distance;angle'; name it with --format, one of recording, carmen"
    ):
        open_recording(tmp_path / "a.txt")
    with pytest.raises(
        RecordingError, match=r"holds none of recording\.toml, \*_motors\.txt, metadata.yaml, only a.txt"
    ):
        open_recording(tmp_path)
    with pytest.raises(RecordingError, match="does not exist"):
        open_recording(tmp_path / "b.log")
    with pytest.raises(RecordingError, match="unknown format 'bag'"):
        open_recording(tmp_path / "a.txt", "bag")


def test_a_pose_graph_with_scans_is_read_out_of_its_archive(tmp_path: Path) -> None:
    scan = "ROBOTLASER1 0 -1.57 3.14 0.5 50 0.1 0 3 1.0 2.0 60.0 0 0 0 0 {x} 0 0 0 0 0 0 0 {time} host {time}"
    lines = [f"VERTEX_SE2 {k} {k} 0 0\n{scan.format(x=k, time=k + 0.5)}" for k in range(3)]
    with zipfile.ZipFile(tmp_path / "a.g2o.zip", "w") as archive:
        archive.writestr("a.g2o", "\n".join(lines))
        archive.writestr("__MACOSX/._a.g2o", "")
    recording = open_recording(tmp_path / "a.g2o.zip")
    assert [scan.odometry[0] for scan in recording.scans] == [0, 1, 2]
    assert np.isinf(recording.scans[0].ranges[2])
    with zipfile.ZipFile(tmp_path / "b.g2o.zip", "w") as archive:
        archive.writestr("a.g2o", "")
        archive.writestr("b.g2o", "")
    with pytest.raises(RecordingError, match="packs 2 files, but one recording is one file"):
        open_recording(tmp_path / "b.g2o.zip")


@with_real_logs
@pytest.mark.parametrize(
    ("path", "scans", "beams", "no_return", "max_range"),
    [
        ("intel/intel.log.gz", 910, 180, 4172, 81.83),
        ("aces/aces.log.gz", 440, 180, 620, 50.0),
        ("lego_arena", 278, 660, 0, 4.0),
        ("crazyflie_corridor/olsson-demo.csv", 428, 120, 0, 4.0),
    ],
)
def test_real_logs_are_read_whole(path: str, scans: int, beams: int, no_return: int, max_range: float) -> None:
    recording = open_recording(Path(REAL or "") / path, strict=path != "lego_arena")
    assert len(recording.scans) == scans
    assert recording.damaged == ()
    assert {scan.ranges.size for scan in recording.scans} == {beams}
    assert sum(int(np.isinf(scan.ranges).sum()) for scan in recording.scans) == no_return
    assert recording.scans[0].sensor.max_range == max_range
