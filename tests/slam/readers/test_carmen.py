"""CARMEN logs: geometry by the number of beams, no-return values found by their frequency, damage told."""

import gzip
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slam.readers.carmen import half_turn_bearings, no_return_value, read_carmen, tell_ties_apart
from slam.readers.recording import RecordingError


def flaser(time: float, ranges: str, beams: int = 4) -> str:
    return f"FLASER {beams} {ranges} 9 9 9 {time} {2 * time} 0.5 {time} nohost {time}\n"


GOOD = "".join(flaser(float(i), f"1.0 2.0 1.5 {3.5 + i / 100:.2f}") for i in range(1, 31))


def written(folder: Path, text: str) -> Path:
    path = folder / "corridor.log"
    path.write_text(text)
    return path


def test_an_even_half_turn_keeps_the_step_of_the_device_and_an_odd_one_reaches_both_sides() -> None:
    assert np.allclose(np.degrees(half_turn_bearings(180)), np.arange(-90, 90))
    assert np.allclose(np.degrees(half_turn_bearings(181)), np.arange(-90, 91))
    assert np.allclose(np.degrees(half_turn_bearings(361)), np.arange(-90, 90.1, 0.5))


def test_a_scan_carries_raw_odometry_time_and_the_mount_of_the_parameters(tmp_path: Path) -> None:
    recording = read_carmen(
        written(tmp_path, "# corridor\nPARAM robot_frontlaser_offset 0.2 nohost 0\n" + GOOD.replace("1.5", "0")), False
    )
    assert len(recording.scans) == 30
    second = recording.scans[1]
    assert np.array_equal(second.odometry, [2.0, 4.0, 0.5])
    assert second.time == 2.0
    assert second.sensor.mount == (0.2, 0.0, 0.0)
    assert np.array_equal(second.ranges, [1.0, 2.0, np.nan, 3.52], equal_nan=True)
    assert recording.damaged == ()


def test_a_value_repeated_by_every_lost_beam_is_no_return_and_farther_codes_with_it(tmp_path: Path) -> None:
    lost = "".join(flaser(100.0 + i, "1.0 2.0 81.83 81.91" if i == 3 else "1.0 2.0 81.83 81.83") for i in range(10))
    recording = read_carmen(written(tmp_path, lost), False)
    assert recording.scans[0].sensor.max_range == 81.83
    assert all(np.isinf(scan.ranges[2:]).all() for scan in recording.scans)


@given(st.lists(st.floats(0.1, 30.0), min_size=20, max_size=60, unique=True))
@settings(deadline=None, max_examples=30)
def test_real_distances_are_never_taken_for_no_return(distances: list[float]) -> None:
    assert no_return_value(np.array(distances)) > max(distances)


@given(st.lists(st.sampled_from([1.0, 2.0, 3.0]), min_size=1, max_size=20))
def test_scans_of_one_stamp_are_told_apart_in_order(stamps: list[float]) -> None:
    times, repeats = tell_ties_apart(np.sort(np.array(stamps)))
    assert (np.diff(times) > 0).all()
    assert np.abs(times - np.sort(stamps)).max() < 1e-3
    assert repeats == len(stamps) - len(set(stamps))


def test_robotlaser_lines_bring_their_own_geometry_and_maximum(tmp_path: Path) -> None:
    line = "ROBOTLASER1 0 -1.0 2.0 0.5 8.0 0.01 0 5 1 2 3 8.1 5 0 1 2 3 4 5 6 0 0 0 0 0 {t} nohost {t}\n"
    recording = read_carmen(written(tmp_path, line.format(t=1) + line.format(t=2)), False)
    scan = recording.scans[0]
    assert np.allclose(scan.bearings, [-1, -0.5, 0, 0.5, 1])
    assert np.array_equal(scan.ranges, [1, 2, 3, np.inf, 5])
    assert np.array_equal(scan.odometry, [4, 5, 6])


def test_a_damaged_line_of_a_long_log_is_left_out_and_told_with_file_and_line(tmp_path: Path) -> None:
    damaged = GOOD + flaser(31.0, "1.0 2.0 3.0", beams=4) + flaser(32.0, "1.0 2.0x 3.0 4.0")
    recording = read_carmen(written(tmp_path, damaged), False)
    assert len(recording.scans) == 30
    assert str(recording.damaged[0]).startswith("corridor.log line 31: 4 ranges are announced, but 3 stand")
    assert str(recording.damaged[1]) == "corridor.log line 32: '2.0x' is not a number"
    with pytest.raises(RecordingError, match=r"corridor\.log line 31"):
        read_carmen(written(tmp_path, damaged), True)


def test_a_log_that_repeats_its_stamps_is_read_and_says_so(tmp_path: Path) -> None:
    recording = read_carmen(written(tmp_path, GOOD + flaser(30.0, "1 2 3 4") + flaser(30.0, "1 2 3 4")), False)
    assert len(recording.scans) == 32
    assert recording.damaged[0].reason.startswith("2 scans repeat the time before theirs")


def test_a_compressed_log_that_breaks_off_gives_what_there_is_and_says_where(tmp_path: Path) -> None:
    path = tmp_path / "corridor.log.gz"
    noise = np.random.default_rng(1).uniform(1, 5, (200, 4)).round(3)
    packed = gzip.compress("".join(flaser(float(i), " ".join(map(str, row))) for i, row in enumerate(noise)).encode())
    path.write_bytes(packed[: len(packed) * 3 // 4])
    recording = read_carmen(path, False)
    assert 50 < len(recording.scans) < 200
    assert "the compressed file breaks off" in recording.damaged[-1].reason
