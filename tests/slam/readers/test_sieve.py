"""The sieve: usable lines pass, each damaged one is kept with its place and reason, and too many are an error."""

import gzip
import zipfile
from pathlib import Path

import numpy as np
import pytest

from slam.readers.recording import RecordingError
from slam.readers.sieve import LineError, Sieve, numbers, refuse_impossible


def written(path: Path, lines: list[str]) -> Path:
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def passed(sieve: Sieve) -> list[float]:
    """The numbers of a file of one number a line."""
    return list(sieve.through(sieve.lines(), lambda text: float(numbers([text])[0])))


def test_damaged_lines_are_left_out_with_file_line_and_reason(tmp_path: Path) -> None:
    path = written(tmp_path / "log", [*map(str, range(20)), "broken"])
    sieve = Sieve(path, strict=False)
    assert passed(sieve) == list(range(20))
    (damaged,) = sieve.damaged
    assert all(part in str(damaged) for part in ("log", "21", "'broken' is not a number"))
    sieve.check()


def test_strict_the_first_damaged_line_is_an_error(tmp_path: Path) -> None:
    sieve = Sieve(written(tmp_path / "log", ["1", "broken", "worse"]), strict=True)
    with pytest.raises(RecordingError, match="'broken'"):
        passed(sieve)


def test_more_damage_than_a_tenth_is_no_recording_and_nothing_is_none(tmp_path: Path) -> None:
    sieve = Sieve(written(tmp_path / "log", [*map(str, range(8)), "broken"]), strict=False)
    passed(sieve)
    with pytest.raises(RecordingError, match="1 of 9 lines are damaged"):
        sieve.check()
    with pytest.raises(RecordingError, match="no scan in it"):
        Sieve(tmp_path / "log", strict=False).check()


def test_packed_files_and_byte_order_marks_are_read_like_plain_ones(tmp_path: Path) -> None:
    text = "\ufeff1\r\n2\r\n".encode()
    (tmp_path / "plain.csv").write_bytes(text)
    with gzip.open(tmp_path / "log.csv.gz", "wb") as packed:
        packed.write(text)
    with zipfile.ZipFile(tmp_path / "log.zip", "w") as archive:
        archive.writestr("__MACOSX/.hidden", "x")
        archive.writestr("log.csv", text)
    for name in ("plain.csv", "log.csv.gz", "log.zip"):
        assert passed(Sieve(tmp_path / name, strict=True)) == [1, 2]


def test_a_file_that_breaks_off_gives_what_it_holds_and_says_so(tmp_path: Path) -> None:
    whole = gzip.compress("\n".join(str(number) for number in np.random.default_rng(0).random(20_000)).encode())
    (tmp_path / "log.gz").write_bytes(whole[: len(whole) // 2])
    sieve = Sieve(tmp_path / "log.gz", strict=False)
    assert len(passed(sieve)) > 5_000
    assert "breaks off" in str(sieve.damaged[-1])


def test_two_files_in_one_archive_are_refused(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "log.zip", "w") as archive:
        archive.writestr("one.csv", "1")
        archive.writestr("two.csv", "2")
    with pytest.raises(RecordingError, match="packs 2 files"):
        passed(Sieve(tmp_path / "log.zip", strict=False))


@pytest.mark.parametrize(("bad", "says"), [(np.nan, "NaN"), (-1.0, "negative"), (0.0, "zero")])
def test_ranges_that_no_sensor_measures_are_named_by_their_place(bad: float, says: str) -> None:
    with pytest.raises(LineError, match=f"range 2 of 3 is {says}"):
        refuse_impossible(np.array([1.0, bad, np.inf]))
