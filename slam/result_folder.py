"""The result of a run as a folder: map, trajectory, odometry, pose graph, settings, report and figures."""

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from backend.room_map import MapEdgeKind, RoomMap
from planners.path import Answer
from slam import toml_file
from slam.decision_file import decisions_text, read_decisions
from slam.perception import perceive
from slam.pipeline import Merged
from slam.planning import answer_values
from slam.pose_graph_file import g2o_text
from slam.readers.recording import Recording
from slam.recordings import open_together
from slam.room_file import points_of_kind, read_features, read_room, room_text
from slam.settings import Settings
from slam.story import Story
from slam.trajectory_file import Trajectory, read_trajectory, tum_text
from slam.whole_output import RESULT_MARK, write_whole

MAP, DECISIONS, TRAJECTORY, ODOMETRY, GRAPH, SETTINGS, REPORT = (
    "map.geojson",
    "decisions.geojson",
    "trajectory.tum",
    "odometry.tum",
    "graph.g2o",
    "settings.toml",
    RESULT_MARK,
)


class ResultError(Exception):
    """A folder that is not the whole result of a run; the message names what is missing."""


@dataclass(frozen=True)
class Source:
    """Where a recording came from: its path, the format if it was named, and the paths of further drives."""

    path: Path
    format_name: str | None
    further: tuple[Path, ...] = ()


def folder_for(recordings: Sequence[Path]) -> Path:
    """Where a map goes if nobody says: here, named after its first recording. Raises ResultError where others lie."""
    first, *further = recordings
    name = first.resolve().name
    if first.is_file():
        name = Path(name.removesuffix(".gz").removesuffix(".zip")).stem
    folder = Path(f"{name}-and-{len(further)}-more-map" if further else f"{name}-map")
    if (folder / REPORT).exists():
        told = read_report(folder)["recording"]
        if [told["path"], *told.get("further", ())] != [str(path.resolve()) for path in recordings]:
            raise ResultError(f"{folder} is the map of {told['path']}, not to be lost: name another folder with --out")
    return folder


def write_result(folder: Path, merged: Merged, recording: Recording, settings: Settings) -> None:
    """All but the report and the figures, which come with what else is known by then."""
    times = np.array([percept.scan.time for percept in merged.percepts])
    trail = recording.odometry or _trail(recording)
    (folder / MAP).write_text(room_text(merged.room, merged.estimate.landmarks), encoding="utf-8")
    (folder / DECISIONS).write_text(decisions_text(merged.room.decisions), encoding="utf-8")
    (folder / TRAJECTORY).write_text(tum_text(times, merged.poses), encoding="utf-8")
    (folder / ODOMETRY).write_text(tum_text(trail.times, trail.poses), encoding="utf-8")
    (folder / GRAPH).write_text(g2o_text(merged.estimate), encoding="utf-8")
    (folder / SETTINGS).write_text(toml_file.dumps(settings), encoding="utf-8")


def report_of(merged: Merged, recording: Recording, source: Source, paths: dict[str, Answer]) -> dict[str, Any]:
    """Counts, seconds per stage, what was refused and why, and the planners' answers."""
    estimate, sensor = merged.estimate, recording.scans[0].sensor
    refused = [made for made in estimate.decisions if not made.accepted]
    return {
        "recording": {
            "name": recording.name,
            "path": str(source.path.resolve()),
            "further": [str(path.resolve()) for path in source.further],
            "format": source.format_name,
            "sensor": sensor.kind,
            "max_range": sensor.max_range,
        },
        "counts": _counts(merged, recording),
        "timings": {stage: round(seconds, 3) for stage, seconds in merged.timings.items()},
        "calibration": estimate.calibration,
        "rejected": [{"what": made.what, "scans": list(made.scans), "reason": made.reason} for made in refused],
        "left_out": np.flatnonzero(~estimate.mapped).tolist(),
        "damaged_lines": [str(damaged) for damaged in recording.damaged],
        "paths": {name: answer_values(answer) for name, answer in paths.items()},
        "scores": {},
    }


def read_report(folder: Path) -> dict[str, Any]:
    """The report of a result folder."""
    try:
        report = json.loads((folder / REPORT).read_text(encoding="utf-8"))
    except OSError as reason:
        raise ResultError(f"{folder} is no result of merge: {REPORT} {(reason.strerror or '').lower()}") from reason
    except (json.JSONDecodeError, UnicodeDecodeError) as damage:
        raise ResultError(f"{folder / REPORT} is not JSON: {damage}") from damage
    if not isinstance(report, dict) or "recording" not in report:
        raise ResultError(f"{folder / REPORT} is no report of merge: it names no recording")
    return report


def write_report(folder: Path, report: dict[str, Any]) -> None:
    """Put the report in its place, whole; numbers that JSON does not know become null."""
    write_whole(folder / REPORT, json.dumps(plain(report), indent=1, allow_nan=False) + "\n")


def recording_of(report: dict[str, Any]) -> Recording:
    """The recording, of one drive or several, that a report was made from."""
    told = report["recording"]
    return open_together([Path(path) for path in (told["path"], *told.get("further", ()))], told["format"])


def story_of(folder: Path) -> Story:
    """What the figures need, from the folder and from the recording it was made from."""
    report = read_report(folder)
    scans = recording_of(report).scans
    settings = toml_file.load(folder / SETTINGS, Settings)
    poses, left_out = read_trajectory(folder / TRAJECTORY).poses, set(report.get("left_out", ()))
    scans = tuple(scan for number, scan in enumerate(scans) if number not in left_out)
    if len(poses) != len(scans):
        raise ResultError(f"{folder / TRAJECTORY} has {len(poses)} poses, but the recording now has {len(scans)} scans")
    paths = {name: np.array(answer["poses"]) for name, answer in report["paths"].items() if answer["poses"]}
    landmarks = points_of_kind(read_features(folder / MAP), "landmark")
    percepts = tuple(perceive(scan, settings.frontend) for scan in scans)
    room = replace(read_room(folder / MAP), decisions=read_decisions(folder / DECISIONS))
    return Story(percepts, poses, room, landmarks, paths)


def _counts(merged: Merged, recording: Recording) -> dict[str, Any]:
    estimate, room = merged.estimate, merged.room
    readings = np.concatenate([scan.ranges for scan in recording.scans])
    decided = Counter((made.what, made.accepted) for made in estimate.decisions)
    return {
        "scans": len(recording.scans),
        "scans left out": len(recording.scans) - len(merged.percepts),
        "damaged lines": len(recording.damaged),
        "readings": readings.size,
        "readings without echo": int(np.isinf(readings).sum()),
        "readings unusable": int(np.isnan(readings).sum()),
        "keyframes": len(estimate.keyframes),
        "landmarks": len(estimate.landmarks),
        **{f"{what} {'accepted' if yes else 'rejected'}": count for (what, yes), count in sorted(decided.items())},
        **_map_counts(room),
    }


def _map_counts(room: RoomMap) -> dict[str, Any]:
    lengths = dict.fromkeys(MapEdgeKind, 0.0)
    for edge in room.edges:
        lengths[edge.kind] += float(np.hypot(edge.end[0] - edge.start[0], edge.end[1] - edge.start[1]))
    return {
        "free area": round(room.free.area, 3),
        "wall edge metres": round(lengths[MapEdgeKind.REAL], 3),
        "frontier metres": round(lengths[MapEdgeKind.FRONTIER], 3),
        "edges": len(room.edges),
        "doors": len(room.doors),
        "obstacles measured": sum(not body.inferred for body in room.obstacles),
        "obstacles inferred": sum(body.inferred for body in room.obstacles),
        "wall leaks": len(room.leaks),
    }


def _trail(recording: Recording) -> Trajectory:
    poses = np.array([scan.odometry for scan in recording.scans])
    return Trajectory(np.array([scan.time for scan in recording.scans]), poses[:, :2], poses[:, 2])


def plain(value: Any) -> Any:
    """The value with numpy numbers as Python's and what is not finite as None."""
    if isinstance(value, dict):
        return {str(key): plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain(part) for part in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    return None if isinstance(value, float) and not np.isfinite(value) else value
