"""The sieve every reader pours its lines through: good ones become values, damaged ones are kept with their reason."""

import gzip
import io
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TextIO, TypeVar

import numpy as np

from frontend.scan import Floats, Scan, ScanError
from slam.readers.recording import DamagedLine, RecordingError

# More than this and the file is not what it was taken for, or too little of the drive is left to speak for it.
MOST_DAMAGED = 0.1
ENCODING = "utf-8-sig"  # spreadsheets begin their files with a byte order mark

Value = TypeVar("Value")


class LineError(Exception):
    """One line that makes no sense; the message says why, whoever knows the file and line adds them."""


class Sieve:
    """Lets the usable lines of one file through. strict: the first damaged line is an error instead."""

    def __init__(self, path: Path, *, strict: bool) -> None:
        self.path = path
        self.strict = strict
        self.damaged: list[DamagedLine] = []
        self.passed = 0
        self.left_out = 0

    def lines(self) -> Iterator[tuple[int, str]]:
        """Numbered lines, from 1, of plain, .gz and .zip files; bytes that are no text become question marks."""
        number = 0
        try:
            with _opened(self.path) as file:
                for number, text in enumerate(file, start=1):
                    yield number, text.rstrip("\r\n")
        except (EOFError, gzip.BadGzipFile, zipfile.BadZipFile, zlib.error) as damage:
            self.note(number + 1, f"the compressed file breaks off ({damage})")
        except OSError as reason:
            raise RecordingError(f"{self.path} cannot be read: {reason.strerror or reason}") from reason

    def through(self, numbered: Iterable[tuple[int, str]], parse: Callable[[str], Value]) -> Iterator[Value]:
        """What `parse` makes of each line; lines it refuses are noted and left out."""
        for number, text in numbered:
            try:
                value = parse(text)
            except (LineError, ScanError) as damage:
                self.left_out += 1
                self.note(number, str(damage))
            else:
                self.passed += 1
                yield value

    def note(self, line: int, reason: str) -> None:
        """Keep the reason why a line is not used as it stands; in strict mode raise RecordingError."""
        damaged = DamagedLine(self.path.name, line, reason)
        if self.strict:
            raise RecordingError(str(damaged))
        self.damaged.append(damaged)

    def check(self) -> None:
        """Raise RecordingError if nothing, or too little, came through."""
        if self.left_out > MOST_DAMAGED * (self.left_out + self.passed):
            raise RecordingError(
                f"{self.damaged[0]} ({self.left_out} of {self.left_out + self.passed} lines are damaged)"
            )
        if self.passed == 0:
            raise RecordingError(f"{self.path}: no scan in it")


def in_time(parse: Callable[[str], Scan], *, repeats: bool = False) -> Callable[[str], Scan]:
    """`parse`, which also refuses scans without usable readings or out of order; repeats: an equal time may pass."""
    last = -np.inf

    def parse_in_time(text: str) -> Scan:
        nonlocal last
        scan = parse(text)
        if scan.time < last or (scan.time == last and not repeats):
            raise LineError(f"time {scan.time:.6f} does not come after {last:.6f}")
        if np.isnan(scan.ranges).all():
            raise LineError(f"none of {scan.ranges.size} ranges is usable")
        last = scan.time
        return scan

    return parse_in_time


def numbers(fields: Sequence[str]) -> Floats:
    """The fields as numbers; the first that is none is named in the LineError."""
    try:
        return np.array(fields, dtype=np.float64)
    except ValueError:
        culprit = next(field for field in fields if not _is_number(field))
        raise LineError(f"{culprit[:40]!r} is not a number") from None


def refuse_impossible(ranges: Floats) -> None:
    """Raise LineError where a range is NaN, negative or zero: no sensor measures these."""
    for wrong, says in ((np.isnan(ranges), "NaN"), (ranges < 0, "negative"), (ranges == 0, "zero")):
        if wrong.any():
            raise LineError(f"range {int(np.argmax(wrong)) + 1} of {ranges.size} is {says}")


def _is_number(field: str) -> bool:
    try:
        float(field)
    except ValueError:
        return False
    return True


def _opened(path: Path) -> TextIO:
    if path.suffix == ".gz":
        return gzip.open(path, "rt", encoding=ENCODING, errors="replace")
    if path.suffix == ".zip":
        packed = zipfile.ZipFile(path)
        # Some archivers add folders and hidden files of their own.
        files = [name for name in packed.namelist() if not name.endswith("/") and "/." not in f"/{name}"]
        if len(files) != 1:
            raise RecordingError(f"{path} packs {len(files)} files, but one recording is one file")
        return io.TextIOWrapper(packed.open(files[0]), encoding=ENCODING, errors="replace")
    return path.open(encoding=ENCODING, errors="replace")
