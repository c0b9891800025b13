"""Opening a recording: the format is guessed from what lies there, or given by name."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from frontend.scan import Scan
from slam.readers.carmen import read_carmen
from slam.readers.crazyflie import COLUMNS, read_crazyflie
from slam.readers.ranges_csv import read_ranges_csv
from slam.readers.recording import DamagedLine, Recording, RecordingError
from slam.readers.recording_folder import read_recording_folder
from slam.readers.ros_bag import read_ros_bag
from slam.readers.sieve import Sieve
from slam.readers.wheel_ticks import read_wheel_ticks

# Each reads a path, strictly (the first damaged line is an error) or not.
READERS: dict[str, Callable[[Path, bool], Recording]] = {
    "recording": read_recording_folder,
    "carmen": read_carmen,
    "ranges-csv": read_ranges_csv,
    "wheel-ticks": read_wheel_ticks,
    "crazyflie": read_crazyflie,
    "ros-bag": read_ros_bag,
}
BAGS = (".bag", ".mcap", ".db3")
FOLDERS = {"recording.toml": "recording", "*_motors.txt": "wheel-ticks", "metadata.yaml": "ros-bag"}


def open_recording(path: Path, format_name: str | None = None, *, strict: bool = False) -> Recording:
    """The recording at `path`; RecordingError says why there is none."""
    if not path.exists():
        raise RecordingError(f"{path} does not exist")
    name = format_name or guess_format(path)
    if name not in READERS:
        raise RecordingError(f"unknown format {name!r}; known are {', '.join(READERS)}")
    return READERS[name](path, strict)


def open_together(paths: Sequence[Path], format_name: str | None = None, *, strict: bool = False) -> Recording:
    """Several recordings as one, drive after drive by the clock; RecordingError says which is none."""
    drives = [open_recording(path, format_name, strict=strict) for path in paths]
    if len(drives) == 1:
        return drives[0]
    drives.sort(key=lambda drive: drive.scans[0].time)
    scans: list[Scan] = []
    notes: list[DamagedLine] = []
    starts: list[int] = []
    for drive in drives:
        notes += drive.damaged
        late = scans[-1].time - drive.scans[0].time if scans else -1.0
        if late >= 0:
            # Two robots may drive at the same time, but a trajectory has one clock.
            notes.append(
                DamagedLine(drive.name, None, f"it overlaps the drive before it: all times are {late + 1:.3f} s later")
            )
        starts.append(len(scans))
        scans += [replace(scan, time=scan.time + late + 1) if late >= 0 else scan for scan in drive.scans]
    name = " and ".join(drive.name for drive in drives)
    return Recording(name, tuple(scans), tuple(notes), drives[0].odometry_noise, starts=tuple(starts[1:]))


def guess_format(path: Path) -> str:
    """The name of the reader for `path`, by its files, its name and, where that does not tell, its first line."""
    if path.is_dir():
        return _guess_folder(path)
    name = path.name.removesuffix(".gz").removesuffix(".zip")
    if name.endswith(BAGS):
        return "ros-bag"
    if name.endswith((".log", ".clf", ".g2o")):  # g2o files with scans keep them as CARMEN's lines
        return "carmen"
    first = next((text for _, text in Sieve(path, strict=True).lines() if text.strip()), "")
    if first == COLUMNS:
        return "crazyflie"
    if re.match(r'"?time"?\s*[,;\t]', first):
        return "ranges-csv"
    if not first:
        raise RecordingError(f"{path}: the file is empty")
    raise RecordingError(
        f"{path.name}: format unknown, for it begins {first[:60]!r}; name it with --format, one of {', '.join(READERS)}"
    )


def _guess_folder(path: Path) -> str:
    for pattern, format_name in FOLDERS.items():
        if any(path.glob(pattern)):
            return format_name
    seen = sorted(file.name for file in path.iterdir())
    raise RecordingError(
        f"{path} holds none of {', '.join(FOLDERS)}, only {', '.join(seen[:5]) or 'nothing'}"
        f"{' and more' if len(seen) > 5 else ''}"
    )
