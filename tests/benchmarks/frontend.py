"""The front end on real lidar scans and in simulated rooms: polylines, knots, relocalisation, doors, free space, time.

The log lies in the folder that ROOMSKETCH_DATA names. Baselines are re-implemented in `polylines` and measured in the
same run.
"""

import os
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import shapely
from scipy.spatial import KDTree

from frontend.contour import Contour, ContourSettings, trace
from frontend.fusion import FusionSettings, fuse
from frontend.matching import Matches, MatchingSettings, match_lost
from frontend.polyline import best_polyline
from frontend.primal_sketch import PrimalSketch, SketchSettings, sketch
from frontend.rigid_motion import between, inverse, transform
from frontend.scan import Floats, Scan
from slam.recordings import open_recording
from slam.trajectory_file import read_trajectory
from tests.benchmarks.door_rooms import door_rooms, free_space_overlap, judge_doors
from tests.benchmarks.polylines import (
    douglas_peucker,
    maximum_likelihood,
    most_likely_readings,
    radial_errors,
    split_and_merge,
    visvalingam,
)
from tests.benchmarks.true_moves import true_moves

PAIRS, RELOCATED, POLYLINES, ROOMS = 300, 200, range(0, 600, 3), 50
NEAR, APART, MOST = 0.1, 0.3, 10  # metres within which a knot is the same, metres apart when thinned, knots a scan
PEERS: dict[str, Callable[[Floats, int], Floats]] = {
    "Douglas–Peucker": douglas_peucker,
    "Visvalingam": visvalingam,
    "split and merge": split_and_merge,
    "maximum likelihood": maximum_likelihood,
}
Row = dict[str, Any]


def rows() -> list[Row]:
    """All rows of the front end."""
    return [*polyline_rows(), *repeatability_rows(), *relocalisation_rows(), *door_rows(), *time_rows()]


@cache
def intel() -> tuple[list[Scan], list[Contour], list[Floats | None]]:
    """Scans of the log, their contours, and the true moves between them."""
    folder = Path(os.environ["ROOMSKETCH_DATA"]) / "intel"
    scans = list(open_recording(folder / "intel.log.gz").scans)[:600]
    contours = [trace(fuse(scan, FusionSettings()), ContourSettings()) for scan in scans]
    poses = read_trajectory(folder / "particle_filter_poses.tum").poses[: PAIRS + 1]
    return scans, contours, true_moves([contour.surface() for contour in contours[: PAIRS + 1]], poses)


def sketches() -> list[PrimalSketch]:
    """Sketches of the scans that have a true move."""
    return [sketch(contour, SketchSettings()) for contour in intel()[1][: PAIRS + 1]]


def rays_of(scan: Scan) -> Floats:
    """Ends of the rays that returned (n, 2), the sensor at the origin."""
    seen = np.isfinite(scan.ranges)
    bearings = scan.bearings[seen]
    return np.asarray(scan.ranges[seen, None] * np.column_stack([np.cos(bearings), np.sin(bearings)]))


def polyline_rows() -> list[Row]:
    """Radial error of the polylines of 10, 20 and 30 vertices, and seconds per scan."""
    rays = [rays_of(intel()[0][k]) for k in POLYLINES]
    methods = {"ours": best_polyline, **PEERS}
    for method in methods.values():
        method(rays[0], 10)  # compiles
    found = []
    note = "mean over scans of the RMS along the rays, every return counted; the target was measured on unknown terms"
    for count, target in ((10, 0.087), (20, 0.055), (30, 0.031)):
        errors, seconds = {}, {}
        for name, method in methods.items():
            clock = perf_counter()
            lines = [method(ends, count) for ends in rays]
            seconds[name] = 1e3 * (perf_counter() - clock) / len(rays)
            errors[name] = float(np.mean([radial_rms(ends, line) for ends, line in zip(rays, lines, strict=True)]))
        fastest = seconds["maximum likelihood"]
        found.append(row(f"polyline error at {count} vertices", errors, "m", "lower", target, note))
        found.append(row(f"polyline time at {count} vertices", seconds, "ms", "lower", fastest, "one core"))
    return found


def radial_rms(rays: Floats, polyline: Floats) -> float:
    """Root mean square of the radial errors of one polyline."""
    return float(np.sqrt(np.mean(radial_errors(rays, polyline) ** 2)))


def repeatability_rows() -> list[Row]:
    """Chance-corrected share of the knots that the next scan finds again."""
    contours = intel()[1]
    rays = [rays_of(scan) for scan in intel()[0][: PAIRS + 1]]
    rates = {"ours": repeatability([thinned(surest(knots)) for knots in sketches()])}
    # Moving the vertices makes them fit better and return less: the peer is taken at its best.
    for name, method in (PEERS | {"maximum likelihood": most_likely_readings}).items():
        rates[name] = repeatability([thinned(method(ends, MOST + 2)[1:-1]) for ends in rays])
    even = repeatability([evenly_spaced(contour) for contour in contours[: PAIRS + 1]])
    note = f"within {NEAR} m, at most {MOST} knots a scan, {APART} m apart, of those the next scan can see"
    return [
        row("knot repeatability", rates, "", "higher", 0.55, note),
        row("evenly spaced points, must be 0", {"ours": abs(even)}, "", "lower", 0.02, note),
    ]


def repeatability(knots: list[Floats]) -> float:
    """(rate − chance) / (1 − chance) over the pairs; knots: (k, 2) of each scan in its own frame."""
    rng = np.random.default_rng(1)
    contours, moves = intel()[1:]
    hits = chances = seen = 0.0
    for k, move in enumerate(moves):
        if move is None or not len(knots[k]):
            continue
        visible = in_view(contours[k + 1], transform(knots[k], inverse(move)))
        seen += len(visible)
        if len(visible) and len(knots[k + 1]):
            again = KDTree(knots[k + 1])
            strays = in_view(contours[k + 1], transform(random_points(contours[k], rng), inverse(move)))
            hits += float(np.sum(again.query(visible)[0] < NEAR))
            chances += len(visible) * float(np.mean(again.query(strays)[0] < NEAR)) if len(strays) else 0.0
    rate, chance = hits / seen, chances / seen
    return (rate - chance) / (1 - chance)


def in_view(contour: Contour, points: Floats) -> Floats:
    """The points (v, 2) that lie in the view or on its boundary."""
    area = contour.free_space.buffer(0.15)
    return points[shapely.contains_xy(area, points[:, 0], points[:, 1])]


def random_points(contour: Contour, rng: np.random.Generator) -> Floats:
    """Points (300, 2) strewn evenly over the boundary."""
    places = rng.uniform(0, contour.arc_length[-1], 300)
    return np.column_stack([np.interp(places, contour.arc_length, axis) for axis in contour.points.T])


def evenly_spaced(contour: Contour) -> Floats:
    """As many points as the knots may be, evenly spaced along the boundary (MOST, 2)."""
    places = (np.arange(MOST) + 0.5) / MOST * contour.arc_length[-1]
    return np.column_stack([np.interp(places, contour.arc_length, axis) for axis in contour.points.T])


def surest(knots: PrimalSketch) -> Floats:
    """Positions of the landmark knots, the surest first."""
    landmarks = np.flatnonzero(knots.landmark)
    doubt = np.trace(knots.covariances[landmarks], axis1=1, axis2=2)
    return np.asarray(knots.positions[landmarks[np.argsort(doubt)]])


def thinned(points: Floats) -> Floats:
    """The first MOST points that lie APART from those before."""
    kept: list[Floats] = []
    for point in points:
        if len(kept) < MOST and all(np.hypot(*(point - other)) >= APART for other in kept):
            kept.append(point)
    return np.array(kept).reshape(-1, 2)


def relocalisation_rows() -> list[Row]:
    """The next scan found without odometry: how often the best guess is right, how often one is accepted and right."""
    knots, moves = sketches(), intel()[2]
    anything = replace(MatchingSettings(), least_clique=1, least_support=0.0, most_contradiction=1.0)
    pairs = [(knots[k], knots[k + 1], moves[k]) for k in range(RELOCATED) if moves[k] is not None]
    guesses = [right(match_lost(a, b, anything), move) for a, b, move in pairs]
    clock = perf_counter()
    matches = [match_lost(a, b, MatchingSettings()) for a, b, _ in pairs]
    milliseconds = 1e3 * (perf_counter() - clock) / len(pairs)
    accepted = [
        right(match, move)
        for match, (_, _, move) in zip(matches, pairs, strict=True)
        if match.pose_in_fixed is not None
    ]
    note = f"{len(pairs)} consecutive pairs, right within 0.2 m and 5°; each pose is verified on the sketches' walls"
    return [
        row("relocalisation: best guess right", {"ours": np.mean(guesses)}, "", "higher", 0.80, note),
        row("relocalisation: accepted", {"ours": len(accepted) / len(pairs)}, "", "higher", 0.55, note),
        row("relocalisation: accepted ones right", {"ours": np.mean(accepted)}, "", "higher", 0.98, note),
        row("relocalisation: time", {"ours": milliseconds}, "ms", "lower", None, "one core"),
    ]


def right(match: Matches, move: Floats | None) -> bool:
    """Whether the pose found lies within 0.2 m and 5° of the true move."""
    if match.pose_in_fixed is None or move is None:
        return False
    off = between(move, match.pose_in_fixed)
    return bool(np.hypot(off[0], off[1]) < 0.2 and abs(off[2]) < np.radians(5))


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
    lidar = intel()[0][:300]
    sonar = [room.scan for room in door_rooms(ROOMS, np.radians(20))]
    return [
        row("front end, 180 beams", {"ours": front_end_time(lidar)}, "ms", "lower", 5.0, "median, one core"),
        row(
            "front end, 256 sonar and infrared readings", {"ours": front_end_time(sonar)}, "ms", "lower", 10.0, "median"
        ),
    ]


def front_end_time(scans: list[Scan]) -> float:
    """Median milliseconds from scan to sketch and surface."""
    seconds = []
    for scan in [scans[0], *scans]:
        clock = perf_counter()
        contour = trace(fuse(scan, FusionSettings()), ContourSettings())
        contour.surface()
        sketch(contour, SketchSettings())
        seconds.append(perf_counter() - clock)
    return 1e3 * float(np.median(seconds[1:]))


def row(name: str, values: dict[str, Any], unit: str, better: str, target: float | None, note: str) -> Row:
    """One row of the table: ours, and the others as peers."""
    peers = {peer: float(value) for peer, value in values.items() if peer != "ours"}
    return {
        "part": "frontend", "name": name, "value": float(values["ours"]), "unit": unit, "better": better,
        "target": target, "peers": peers, "runs": 1, "note": note,
    }  # fmt: skip
