"""Range tables: CSV with a scan in each row, under a header `time,x,y,heading,range@-90,range@-89.5,…` in degrees.

Spreadsheets also part columns by semicolons or tabs, and write decimal commas where semicolons part them.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frontend.scan import Floats, Scan, Sensor
from slam.readers.sieve import LineError, numbers, refuse_impossible

POSE_COLUMNS = ["time", "x", "y", "heading"]
SEPARATORS = ",;\t"
FARTHEST = 1000.0  # metres; no sensor that maps rooms reaches farther


@dataclass(frozen=True, eq=False)
class Header:
    """bearings: (n,) radians, increasing. infrared: whether n columns of infrared codes follow the n of ranges.

    separator: what parts the columns.
    """

    bearings: Floats
    infrared: bool
    separator: str = ","

    @property
    def columns(self) -> int:
        """How many fields a row has."""
        return len(POSE_COLUMNS) + self.bearings.size * (2 if self.infrared else 1)


def parse_header(text: str) -> Header:
    """The header's bearings; LineError says which column is wrong."""
    separator = max(SEPARATORS, key=text.count)
    columns = _fields(text, separator)
    if columns[:4] != POSE_COLUMNS:
        begins = f"the header begins {','.join(columns[:4])[:60]!r}, but should begin 'time,x,y,heading'"
        raise LineError(f"{begins}; where no wheels were read, x, y and heading are 0")
    ranges, codes = _degrees(columns, "range@"), _degrees(columns, "infrared@")
    for column in columns[4:]:
        if not column.startswith(("range@", "infrared@")):
            raise LineError(f"column {column[:40]!r} is neither range@DEGREES nor infrared@DEGREES")
    if codes.size and not np.array_equal(codes, ranges):
        raise LineError(f"{codes.size} infrared columns do not repeat the bearings of {ranges.size} ranges")
    if ranges.size == 0 or (np.diff(ranges) <= 0).any() or np.ptp(ranges) > 360:
        raise LineError(f"{ranges.size} bearings do not increase strictly within one turn")
    return Header(np.radians(ranges), bool(codes.size), separator)


def parse_row(text: str, header: Header, sensor: Sensor) -> Scan:
    """One row as a scan; an empty range or `inf` means that no echo came, `nan` that the reading failed."""
    fields = _fields(text, header.separator)
    if len(fields) != header.columns:
        raise LineError(_count(len(fields), header))
    pose_and_time = numbers(fields[:4])
    if not np.isfinite(pose_and_time).all():
        raise LineError(f"{POSE_COLUMNS[int(np.argmin(np.isfinite(pose_and_time)))]} is not finite")
    split = 4 + header.bearings.size
    ranges = numbers([field or "inf" for field in fields[4:split]])
    refuse_impossible(np.where(np.isnan(ranges), np.inf, ranges))
    _refuse_too_far(ranges)
    codes = _codes(fields[split:]) if header.infrared else None
    return Scan(header.bearings, ranges, sensor, pose_and_time[1:], float(pose_and_time[0]), codes)


def _fields(text: str, separator: str) -> list[str]:
    plain = text.replace(",", ".") if separator == ";" else text
    return [field.strip().strip('"') for field in plain.split(separator)]


def _refuse_too_far(ranges: Floats) -> None:
    far = np.isfinite(ranges) & (ranges > FARTHEST)
    if far.any():
        worst = int(np.argmax(far))
        raise LineError(
            f"range {worst + 1} of {ranges.size} is {ranges[worst]:g} m, but no sensor for rooms reaches "
            f"{FARTHEST:g} m: ranges are metres, and empty where no echo came"
        )


def _degrees(columns: list[str], prefix: str) -> Floats:
    return numbers([column.removeprefix(prefix) for column in columns if column.startswith(prefix)])


def _count(found: int, header: Header) -> str:
    beams, expected = header.bearings.size, header.columns
    if header.infrared:
        return f"{found} fields, but time, pose, {beams} ranges and {beams} infrared codes make {expected}"
    return (
        f"{found - 4} ranges, but {beams} bearings" if found >= 4 else f"{found} fields, but the header has {expected}"
    )


def _codes(fields: list[str]) -> NDArray[np.int16]:
    codes = numbers(fields)
    if not ((codes >= 0) & (codes <= 99) & (codes == np.round(codes))).all():
        raise LineError("an infrared code is not a whole number of two digits")
    return codes.astype(np.int16)
