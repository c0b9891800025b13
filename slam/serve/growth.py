"""The task behind a growing map: a recording is merged scan by scan, and every step is told to the page.

It takes the same steps with the same settings as `slam.pipeline`; a look at the map in between changes nothing in it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

from backend.polygon_merging import Merger
from slam.mapper import Mapper
from slam.pipeline import Merged, merged_so_far
from slam.planning import tour_or_reason
from slam.readers.recording import Recording
from slam.recordings import open_recording
from slam.result_folder import Source, read_report, report_of, write_report, write_result
from slam.serve.messages import pack, poses_message, room_message, scan_message
from slam.serve.report import report_message
from slam.serve.truth import Truth, truth_messages
from slam.settings import Settings, knowing
from slam.whole_output import whole_folder

LOOK_SHARE = 0.25  # of the time spent so far may go into looking at the half-grown map; larger shows it more often


@dataclass(frozen=True)
class Errand:
    """What to merge and where to put the result. truth: where the true plan and poses may lie."""

    source: Source
    result: Path
    truth: Truth


def grow(errand: Errand) -> Iterator[bytes]:
    """Messages of a whole run; at its end the result folder is there. Raises what `slam.failures` foresees."""
    drive = open_recording(errand.source.path, errand.source.format_name)
    settings = knowing(Settings(), drive.odometry_noise)
    yield opening_message(drive, len(drive.scans))
    mapper = Mapper(settings.frontend, settings.poses)
    looks = _Looks(mapper, settings)
    for index, scan in enumerate(drive.scans):
        pose = mapper.add(scan)
        yield scan_message(index, mapper.percepts[-1], pose)
        yield from looks.look_if_due()
    yield pack("stage", {"says": "solving the graph and merging all views"})
    merged = merged_so_far(mapper, settings)
    yield from result_messages(merged, final=True)
    yield pack("stage", {"says": "planning a tour"})
    report = _written(merged, drive, errand, settings)
    yield report_message(report)
    yield from truth_messages(errand.truth, errand.result, merged.room, drive.scans)


def opening_message(drive: Recording, scans: int) -> bytes:
    """What is known before the first scan."""
    sensor = drive.scans[0].sensor
    says: dict[str, Any] = {"name": drive.name, "scans": scans, "sensor": sensor.kind, "reach": sensor.max_range}
    return pack("opening", says)


def result_messages(merged: Merged, *, final: bool) -> Iterator[bytes]:
    """Where everything is, as now known."""
    estimate = merged.estimate
    yield poses_message(estimate.poses, estimate.covariances, estimate.mapped)
    yield room_message(merged.room, estimate.mapped, estimate.landmarks, final=final)


class _Looks:
    """Merges the views so far now and then: as often as a fixed share of the time allows."""

    def __init__(self, mapper: Mapper, settings: Settings) -> None:
        self._mapper, self._settings, self._merger = mapper, settings, Merger(settings.merging)
        self._since, self._spent = perf_counter(), 0.0

    def look_if_due(self) -> Iterator[bytes]:
        """The poses and the map of the scans so far, or nothing yet."""
        clock = perf_counter()
        if self._spent > LOOK_SHARE * (clock - self._since):
            return
        yield from result_messages(merged_so_far(self._mapper, self._settings, self._merger), final=False)
        self._spent += perf_counter() - clock


def _written(merged: Merged, drive: Recording, errand: Errand, settings: Settings) -> dict[str, Any]:
    """The result folder of the run, without figures: these are drawn when somebody takes them. Its report."""
    paths, trouble = tour_or_reason(merged.room.safety, merged.poses[0], settings.planning)
    report = report_of(merged, drive, errand.source, paths) | {"tour": trouble}
    with whole_folder(errand.result) as folder:
        write_result(folder, merged, drive, settings)
        write_report(folder, report)
    return read_report(errand.result)
