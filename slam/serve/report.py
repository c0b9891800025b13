"""The report of a run, as far as the page shows it."""

from typing import Any

from slam.result_folder import plain
from slam.serve.messages import pack

MOST_TOLD = 200  # lines of one list on the page; the whole report can be taken away


def report_message(report: dict[str, Any]) -> bytes:
    """Counts, timings, calibration, scores; what was refused and why, as much as fits on a page; the tour."""
    rejected, damaged = report["rejected"], report["damaged_lines"]
    says = {
        "counts": report["counts"],
        "timings": report["timings"],
        "calibration": report["calibration"],
        "scores": report["scores"],
        "rejected": rejected[:MOST_TOLD],
        "rejectedCount": len(rejected),
        "damaged": damaged[:MOST_TOLD],
        "damagedCount": len(damaged),
        "paths": report["paths"],
        "tour": report.get("tour"),
    }
    return pack("report", plain(says))
