"""Files from outside: their names, their number and what they unpack to are bounded before anything reads them."""

import gzip
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from slam.readers.recording import RecordingError
from slam.serve.uploads import check_unpacked, safe_name


@given(st.text(max_size=300))
def test_no_name_leads_out_of_its_folder(name: str) -> None:
    safe = safe_name(name)
    assert "/" not in safe
    assert "\\" not in safe
    assert not safe.startswith(".")
    assert len(safe) <= 100


@pytest.mark.parametrize(
    ("name", "safe"),
    [
        ("intel.log.gz", "intel.log.gz"),
        ("../../etc/passwd.csv", "passwd.csv"),
        ("C:\\drive\\my log.csv", "my_log.csv"),
        ("...hidden.csv", "hidden.csv"),
        ("", ""),
    ],
)
def test_names_keep_what_tells_the_format(name: str, safe: str) -> None:
    assert safe_name(name) == safe


def test_a_bomb_is_not_unpacked_to_its_end(tmp_path: Path) -> None:
    bomb = tmp_path / "bomb.csv.gz"
    bomb.write_bytes(gzip.compress(bytes(3 << 20)))
    with pytest.raises(RecordingError, match=r"bomb\.csv\.gz unpacks to more than the 2 MB that are allowed"):
        check_unpacked([bomb], 2)
    check_unpacked([bomb], 3)


def test_bombs_are_counted_together_and_member_by_member(tmp_path: Path) -> None:
    for name in ("one.log.gz", "two.log.gz"):
        (tmp_path / name).write_bytes(gzip.compress(bytes(1 << 20)) + gzip.compress(bytes(1 << 20)))
    with pytest.raises(RecordingError, match=r"two\.log\.gz unpacks"):
        check_unpacked(sorted(tmp_path.iterdir()), 3)
    check_unpacked(sorted(tmp_path.iterdir()), 4)


def test_a_broken_or_plain_file_is_left_to_its_reader(tmp_path: Path) -> None:
    (tmp_path / "broken.log.gz").write_bytes(gzip.compress(b"text")[:-9] + b"????")
    (tmp_path / "no.log.gz").write_bytes(b"this was never packed")
    (tmp_path / "plain.log").write_bytes(bytes(5 << 20))
    check_unpacked(sorted(tmp_path.iterdir()), 1)
