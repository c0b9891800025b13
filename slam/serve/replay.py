"""The task behind a result that is there already: the same messages as while it grew, as far as its files go."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from frontend.scan import Floats
from slam import toml_file
from slam.perception import perceive
from slam.readers.recording import Recording, RecordingError
from slam.result_folder import MAP, SETTINGS, TRAJECTORY, read_report, recording_of
from slam.room_file import points_of_kind, read_features, read_room
from slam.serve.growth import opening_message
from slam.serve.messages import pack, poses_message, room_message, scan_message
from slam.serve.report import report_message
from slam.serve.truth import Truth, truth_messages
from slam.settings import Settings
from slam.trajectory_file import read_trajectory


def replay(result: Path, truth: Truth) -> Iterator[bytes]:
    """Map and report at once, then scan after scan. Raises what `slam.failures` foresees."""
    report, room = read_report(result), read_room(result / MAP)
    poses = read_trajectory(result / TRAJECTORY).poses
    landmarks = points_of_kind(read_features(result / MAP), "landmark")
    drive = _drive(report, len(poses))
    yield _opening(report, drive, len(poses))
    yield poses_message(poses)
    yield room_message(room, len(poses), landmarks, final=True)
    yield report_message(report)
    if isinstance(drive, Recording):
        yield from _scans(drive, poses, toml_file.load(result / SETTINGS, Settings))
        yield from truth_messages(truth, result, room, drive.scans)
    else:
        yield pack("note", {"says": f"The scans cannot be shown: {drive}."})


def _drive(report: dict[str, Any], poses: int) -> Recording | str:
    """The recording, or why its scans cannot be shown: a map is worth showing without them."""
    try:
        drive = recording_of(report)
    except RecordingError as reason:
        return str(reason)
    if len(drive.scans) != poses:
        return f"the result has {poses} poses, but its recording now has {len(drive.scans)} scans"
    return drive


def _opening(report: dict[str, Any], drive: Recording | str, scans: int) -> bytes:
    if isinstance(drive, Recording):
        return opening_message(drive, scans)
    told = report["recording"]
    says = {"name": told["name"], "scans": scans, "sensor": told["sensor"], "reach": told["max_range"]}
    return pack("opening", says)


def _scans(drive: Recording, poses: Floats, settings: Settings) -> Iterator[bytes]:
    for index, (scan, pose) in enumerate(zip(drive.scans, poses, strict=True)):
        yield scan_message(index, perceive(scan, settings.frontend), np.asarray(pose))
