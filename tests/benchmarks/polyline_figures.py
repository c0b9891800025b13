"""Polylines of a given number of vertices on a real log: how close, how much of the scan, how fast."""

from collections.abc import Callable
from time import process_time

import numpy as np

from frontend.best_polylines import Polylines, best_polylines
from frontend.scan import Booleans, Floats, Scan
from tests.benchmarks.likely_polylines import maximum_likelihood
from tests.benchmarks.polylines import douglas_peucker, may_join, radial_errors, split_and_merge, visvalingam
from tests.benchmarks.real_logs import real_log
from tests.benchmarks.row import Row, row

Method = Callable[[Floats, Booleans, int], Polylines]


def rays_of(scan: Scan) -> tuple[Floats, Booleans]:
    """Ends of the rays that returned (n, 2), the sensor at the origin, and which a line may join to the next (n,)."""
    beams = np.flatnonzero(np.isfinite(scan.ranges))
    bearings = scan.bearings[beams]
    rays = scan.ranges[beams, None] * np.column_stack([np.cos(bearings), np.sin(bearings)])
    return rays, may_join(rays, beams)


def our_polylines(rays: Floats, joined: Booleans, count: int) -> Polylines:
    """Ours, at a charge for undrawn rays that draws as many as the maximum likelihood does."""
    return best_polylines(rays, joined, count, 0.42)


METHODS: dict[str, Method] = {
    "ours": our_polylines,
    "Douglas–Peucker": douglas_peucker,
    "Visvalingam": visvalingam,
    "split and merge": split_and_merge,
    "maximum likelihood": maximum_likelihood,
}


def polyline_rows() -> list[Row]:
    """Radial error of the polylines of 10, 20 and 30 vertices, the share of rays they draw, and time per scan."""
    views = [rays_of(scan) for scan in real_log("intel", 0, 599).scans]
    found = []
    for count, target in ((10, 0.087), (20, 0.055), (30, 0.031)):
        figures = {name: polyline_figures(method, views, count) for name, method in METHODS.items()}
        errors, shares, times = ({name: each[k] for name, each in figures.items()} for k in range(3))
        note = f"mean over {len(views)} scans of the RMS along the rays drawn; broken where ends lie over 1 m apart"
        found += [
            row(f"polyline error at {count} vertices", errors, "m", "lower", target, note),
            row(
                f"rays drawn at {count} vertices", shares, "", "higher", shares["maximum likelihood"], "of all returns"
            ),
            row(
                f"polyline time at {count} vertices", times, "ms", "lower", times["maximum likelihood"], "CPU per scan"
            ),
        ]
    return found


def polyline_figures(method: Method, views: list[tuple[Floats, Booleans]], count: int) -> tuple[float, float, float]:
    """Mean radial RMS in metres, mean share of the rays drawn, and milliseconds of CPU per scan."""
    method(*views[0], count)  # compiles
    clock = process_time()
    lines = [method(*view, count) for view in views]
    milliseconds = 1e3 * (process_time() - clock) / len(views)
    errors = [radial_errors(rays, drawn) for (rays, _), drawn in zip(views, lines, strict=True)]
    rms = [float(np.sqrt(np.nanmean(missed**2))) for missed in errors]
    return float(np.mean(rms)), float(np.mean([np.mean(~np.isnan(missed)) for missed in errors])), milliseconds
