"""Recording folders: facts in degrees become a sensor in radians; unknown facts are refused."""

import math
import shutil
from pathlib import Path

import pytest

from slam.readers.recording import RecordingError
from slam.readers.recording_folder import read_recording_folder
from slam.toml_file import TomlFileError

FACTS = """name = "attic"
[sensor]
kind = "sonar_infrared"
max_range = 10.7
half_beam_degrees = 10.0
infrared_range = 3.0
mount = [0.1, 0.0, 90.0]
[odometry]
distance_noise = 0.05
turn_noise = 0.02
turn_per_metre_noise = 0.01
"""
TABLE = "time,x,y,heading,range@-90,range@90\n1,0,0,0,1,\n2,0.5,0,0,1,2\n"


def written(folder: Path, facts: str, table: str) -> Path:
    (folder / "recording.toml").write_text(facts)
    (folder / "readings.csv").write_text(table)
    return folder


def test_the_facts_of_the_folder_reach_every_scan(tmp_path: Path) -> None:
    recording = read_recording_folder(written(tmp_path, FACTS, TABLE), True)
    assert recording.name == "attic"
    sensor = recording.scans[1].sensor
    assert sensor.half_beam == pytest.approx(math.radians(10))
    assert sensor.mount == (0.1, 0.0, math.pi / 2)
    assert recording.odometry_noise is not None
    assert recording.odometry_noise.distance_noise == 0.05


def test_an_unknown_fact_is_refused_with_the_known_ones(tmp_path: Path) -> None:
    with pytest.raises(
        TomlFileError, match=r"unknown key sensor\.beam; known are half_beam_degrees, half_beams, infrared_range"
    ):
        read_recording_folder(written(tmp_path, FACTS.replace("half_beam_degrees", "beam"), TABLE), False)


def test_a_short_recording_does_not_lose_a_scan_in_silence(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"readings\.csv line 3: 1 ranges, but 2 bearings \(1 of 2 lines"):
        read_recording_folder(written(tmp_path, FACTS, TABLE.replace("1,2\n", "1\n")), False)


def test_time_does_not_stand_still(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"line 3: time 1\.000000 does not come after 1\.000000"):
        read_recording_folder(written(tmp_path, FACTS, TABLE.replace("2,0.5", "1,0.5")), True)


def test_a_sonar_whose_beam_nobody_measured_tells_it_by_its_arcs(tmp_path: Path) -> None:
    apartment = Path(__file__).parents[3] / "datasets" / "apartment"
    shutil.copy(apartment / "readings.csv.gz", tmp_path)
    facts = (apartment / "recording.toml").read_text().splitlines()
    kept = [line for line in facts if not line.startswith("half_beam")]
    (tmp_path / "recording.toml").write_text("\n".join(kept))
    stated = read_recording_folder(apartment, False).scans[0].sensor
    told = read_recording_folder(tmp_path, False).scans[0].sensor
    for metres, angle in told.half_beams:
        assert 0.5 * stated.half_beam_at(metres) < angle <= stated.half_beam_at(metres)


def test_a_sonar_of_too_few_arcs_is_said_to_be_taken_as_it_was_read(tmp_path: Path) -> None:
    facts = FACTS.replace("half_beam_degrees = 10.0\n", "")
    recording = read_recording_folder(written(tmp_path, facts, TABLE), False)
    assert recording.scans[0].sensor.half_beam == 0
    assert "clean arcs of walls" in str(recording.damaged[-1])


@pytest.mark.parametrize("elsewhere", ["/etc/passwd", "../readings.csv", "inner/readings.csv"])
def test_readings_lie_in_the_folder_and_nowhere_else(tmp_path: Path, elsewhere: str) -> None:
    facts = f'readings = "{elsewhere}"\n{FACTS}'
    with pytest.raises(RecordingError, match="may lie outside the folder, but must be a file in it"):
        read_recording_folder(written(tmp_path, facts, TABLE), False)
