"""The task behind a result that is there already: the same messages as while it grew, as far as its files go."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from frontend.scan import Scan
from slam import toml_file
from slam.perception import perceive
from slam.readers.recording import RecordingError
from slam.result_folder import MAP, SETTINGS, TRAJECTORY, read_report, recording_of
from slam.room_file import points_of_kind, read_features, read_room
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
    scenes = _scenes(result, report, len(poses))
    yield _opening(report, len(poses))
    yield poses_message(poses)
    yield room_message(room, np.ones(len(poses), np.bool_), landmarks, final=True)
    yield report_message(report)
    if isinstance(scenes, str):
        yield pack("note", {"says": f"The scans cannot be shown: {scenes}."})
        return
    scans, settings = scenes
    for index, (scan, pose) in enumerate(zip(scans, poses, strict=True)):
        yield scan_message(index, perceive(scan, settings.frontend), np.asarray(pose))
    yield from truth_messages(truth, result, room, scans)


def _scenes(result: Path, report: dict[str, Any], poses: int) -> tuple[tuple[Scan, ...], Settings] | str:
    """The scans that stand in the map with the run's settings, or why there are none: a map is worth showing alone."""
    try:
        drive, settings = recording_of(report), toml_file.load(result / SETTINGS, Settings)
    except (RecordingError, toml_file.TomlFileError) as reason:
        return str(reason)
    left_out = set(report.get("left_out", ()))
    scans = tuple(scan for number, scan in enumerate(drive.scans) if number not in left_out)
    if len(scans) != poses:
        return f"the result has {poses} poses, but its recording now has {len(scans)} scans for them"
    return scans, settings


def _opening(report: dict[str, Any], scans: int) -> bytes:
    told = report["recording"]
    says = {"name": told["name"], "scans": scans, "sensor": told["sensor"], "reach": told["max_range"]}
    return pack("opening", says)
