"""The front end on real scans and in simulated rooms: polylines, knots, relocalisation, doors, free space, time."""

from time import process_time

import numpy as np

from frontend.contour import ContourSettings, trace
from frontend.fusion import FusionSettings, fuse
from frontend.primal_sketch import SketchSettings, sketch
from frontend.scan import Scan
from tests.benchmarks.door_rooms import door_rooms, free_space_overlap, judge_doors
from tests.benchmarks.knot_figures import relocalisation_rows, repeatability_rows
from tests.benchmarks.polyline_figures import polyline_rows
from tests.benchmarks.real_logs import real_log
from tests.benchmarks.row import Row, row

ROOMS = 50


def rows() -> list[Row]:
    """All rows of the front end."""
    return [*polyline_rows(), *repeatability_rows(), *relocalisation_rows(), *door_rows(), *time_rows()]


def door_rows() -> list[Row]:
    """Doors and free space of single views in simulated rooms, at two effective half-beams."""
    found = []
    for degrees, target in ((10, 0.80), (20, 0.70)):
        rooms = door_rooms(ROOMS, np.radians(degrees))
        visible, hit, opened, false_doors = np.sum([judge_doors(room) for room in rooms], axis=0)
        ours, raw, false = np.mean([free_space_overlap(room) for room in rooms], axis=0)
        note = f"{ROOMS} rooms, 256 readings, effective half-beam {degrees}°"
        found += [
            row(f"door edges found at {degrees}°", {"ours": hit / visible}, "", "higher", 0.95, note),
            row(f"false doors at {degrees}°", {"ours": false_doors / opened}, "", "lower", 0.05, note),
            row(f"single-view IoU at {degrees}°", {"ours": ours, "raw": raw}, "", "higher", target, note),
            row(f"false free area at {degrees}°", {"ours": false}, "", "lower", 0.005, note),
        ]
    return found


def time_rows() -> list[Row]:
    """Median seconds of the whole front end, scan to sketch."""
    lidar = real_log("intel", 0, 599).scans[:300]
    sonar = [room.scan for room in door_rooms(ROOMS, np.radians(20))]
    return [
        row("front end, 180 beams", {"ours": front_end_time(lidar)}, "ms", "lower", 5.0, "median of CPU"),
        row(
            "front end, 256 sonar and infrared readings",
            {"ours": front_end_time(sonar)},
            "ms",
            "lower",
            10.0,
            "median of CPU",
        ),
    ]


def front_end_time(scans: list[Scan]) -> float:
    """Median milliseconds of CPU from scan to sketch and surface."""
    seconds = []
    for scan in [scans[0], *scans]:
        clock = process_time()
        contour = trace(fuse(scan, FusionSettings()), ContourSettings())
        contour.surface()
        sketch(contour, SketchSettings())
        seconds.append(process_time() - clock)
    return 1e3 * float(np.median(seconds[1:]))
