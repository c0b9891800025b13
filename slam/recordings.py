"""Opening a recording: the format is guessed from what lies there, or given by name."""

from collections.abc import Callable
from pathlib import Path

from slam.readers.carmen import read_carmen
from slam.readers.crazyflie import COLUMNS, read_crazyflie
from slam.readers.ranges_csv import read_ranges_csv
from slam.readers.recording import Recording, RecordingError
from slam.readers.recording_folder import read_recording_folder
from slam.readers.sieve import Sieve
from slam.readers.wheel_ticks import read_wheel_ticks

# Each reads a path, strictly (the first damaged line is an error) or not.
READERS: dict[str, Callable[[Path, bool], Recording]] = {
    "recording": read_recording_folder,
    "carmen": read_carmen,
    "ranges-csv": read_ranges_csv,
    "wheel-ticks": read_wheel_ticks,
    "crazyflie": read_crazyflie,
}


def open_recording(path: Path, format_name: str | None = None, *, strict: bool = False) -> Recording:
    """The recording at `path`; RecordingError says why there is none."""
    if not path.exists():
        raise RecordingError(f"{path} does not exist")
    name = format_name or guess_format(path)
    if name not in READERS:
        raise RecordingError(f"unknown format {name!r}; known are {', '.join(READERS)}")
    return READERS[name](path, strict)


def guess_format(path: Path) -> str:
    """The name of the reader for `path`, by its files, its name and, for a CSV, its header."""
    if path.is_dir():
        if (path / "recording.toml").exists():
            return "recording"
        if list(path.glob("*_motors.txt")):
            return "wheel-ticks"
        raise RecordingError(f"{path} holds neither recording.toml nor *_motors.txt with *_scan.txt")
    name = path.name.removesuffix(".gz")
    if name.endswith(".log"):
        return "carmen"
    if name.endswith(".csv"):
        _, header = next(Sieve(path, strict=True).lines(), (1, ""))
        return "crazyflie" if header == COLUMNS else "ranges-csv"
    raise RecordingError(f"{path.name}: format unknown; name it with --format, one of {', '.join(READERS)}")
