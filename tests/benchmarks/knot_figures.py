"""Knots of a real log: how many the next scan finds again, and whether they say where it was taken from."""

from time import process_time

import numpy as np
import shapely
from scipy.spatial import KDTree

from frontend.contour import Contour
from frontend.matching import MatchingSettings, match_lost
from frontend.primal_sketch import PrimalSketch
from frontend.rigid_motion import between, inverse, transform
from frontend.scan import Floats
from tests.benchmarks.likely_polylines import most_likely_readings
from tests.benchmarks.polyline_figures import Method, rays_of
from tests.benchmarks.polylines import douglas_peucker, split_and_merge, visvalingam
from tests.benchmarks.real_logs import RealLog, real_log
from tests.benchmarks.row import Row, row

NEAR, APART, MOST = 0.1, 0.3, 10  # metres within which a knot is the same, metres apart when thinned, knots a scan
PAIRS, RELOCATED = 300, 200
# Moving the vertices makes them fit better and return less: the likelihood is taken at its best.
PEERS: dict[str, Method] = {
    "Douglas–Peucker": douglas_peucker,
    "Visvalingam": visvalingam,
    "split and merge": split_and_merge,
    "maximum likelihood": most_likely_readings,
}


def repeatability_rows() -> list[Row]:
    """Chance-corrected share of the knots that the next scan finds again, in two buildings."""
    note = f"within {NEAR} m, at most {MOST} knots a scan, {APART} m apart, of those the next scan can see"
    found = []
    for name, target in (("intel", 0.55), ("aces", None)):
        log = real_log(name, 0, PAIRS)
        rates = {"ours": repeatability(log, [thinned(surest(knots)) for knots in log.sketches])}
        for peer, method in PEERS.items():
            rates[peer] = repeatability(log, [thinned(inner_vertices(method, rays_of(scan)[0])) for scan in log.scans])
        even = repeatability(log, [evenly_spaced(contour) for contour in log.contours])
        found += [
            row(f"knot repeatability, {name}", rates, "", "higher", target, note),
            row(f"evenly spaced points, must be 0, {name}", {"ours": abs(even)}, "", "lower", 0.02, note),
        ]
    return found


def inner_vertices(method: Method, rays: Floats) -> Floats:
    """The vertices (v, 2) of one line through every ray, without its two ends."""
    joined = np.append(np.ones(rays.shape[0] - 1, dtype=np.bool_), False)
    return method(rays, joined, MOST + 2).vertices[1:-1]


def repeatability(log: RealLog, knots: list[Floats]) -> float:
    """(rate − chance) / (1 − chance) over the pairs; knots: (k, 2) of each scan in its own frame."""
    rng = np.random.default_rng(1)
    hits = chances = seen = 0.0
    for k, move in enumerate(log.moves):
        if move is None or not len(knots[k]):
            continue
        visible = in_view(log.contours[k + 1], transform(knots[k], inverse(move)))
        seen += len(visible)
        if len(visible) and len(knots[k + 1]):
            again = KDTree(knots[k + 1])
            strays = in_view(log.contours[k + 1], transform(random_points(log.contours[k], rng), inverse(move)))
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
    found = []
    for name, first in (("intel", 0), ("aces", 200)):
        log = real_log(name, first, first + RELOCATED)
        pairs = [(log.sketches[k], log.sketches[k + 1], move) for k, move in enumerate(log.moves) if move is not None]
        clock = process_time()
        matches = [match_lost(fixed, moving, MatchingSettings()) for fixed, moving, _ in pairs]
        milliseconds = 1e3 * (process_time() - clock) / len(pairs)
        guesses = [right(match.best_guess, move) for match, (_, _, move) in zip(matches, pairs, strict=True)]
        accepted = [
            right(match.pose_in_fixed, move)
            for match, (_, _, move) in zip(matches, pairs, strict=True)
            if match.pose_in_fixed is not None
        ]
        note = f"{len(pairs)} consecutive pairs of {name}, right within 0.2 m and 5°, verified on the sketches' walls"
        found += [
            row(f"relocalisation: best guess right, {name}", {"ours": np.mean(guesses)}, "", "higher", 0.80, note),
            row(f"relocalisation: accepted, {name}", {"ours": len(accepted) / len(pairs)}, "", "higher", 0.55, note),
            row(f"relocalisation: accepted ones right, {name}", {"ours": np.mean(accepted)}, "", "higher", 0.98, note),
            row(f"relocalisation: time, {name}", {"ours": milliseconds}, "ms", "lower", None, "CPU per pair"),
        ]
    return found


def right(pose: Floats | None, move: Floats) -> bool:
    """Whether the pose found lies within 0.2 m and 5° of the true move."""
    if pose is None:
        return False
    off = between(move, pose)
    return bool(np.hypot(off[0], off[1]) < 0.2 and abs(off[2]) < np.radians(5))
