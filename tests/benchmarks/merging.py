"""Merging: furnished plans with misplaced views, against other ways to merge; order, time and memory."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon

from backend.contours import as_polygons
from backend.map_reading import ReadingSettings
from backend.polygon_merging import Merger, merge_views
from backend.provenance import boundary_edges
from backend.room_map import MapEdge, MapEdgeKind, RoomMap
from slam.scores.maps import MapScores, MapTruth, score_map
from tests.backend.plan_rays import Rays, furnished_plan, misplaced, scattered_poses, view_of
from tests.benchmarks.merged_paths import Paths, paths_on
from tests.benchmarks.merging_cases import VIEWS, Case, furnished_case
from tests.benchmarks.merging_peers import PEERS

Row = dict[str, Any]
PLANS = 20
NOISES = ((0.02, 0.3), (0.05, 0.5))
TARGETS = {"IoU": (0.985, 0.975), "boundary F1 at 5 cm": (0.98, 0.93), "wall breach": (0.0, 0.0)}


def rows() -> list[Row]:
    """All rows of the part."""
    return [*against_peers("furnished plans", [furnished_case(number) for number in range(PLANS)]), *_by_size()]


def against_peers(plans: str, cases: list[Case]) -> list[Row]:
    """Rows of every measure at both noises, beside the other ways to merge."""
    found: list[Row] = []
    for level, (metres, degrees) in enumerate(NOISES):
        rng = np.random.default_rng(77)
        placed = [misplaced(case.poses, metres, degrees, rng) for case in cases]
        maps = [merge_views(case.views, poses) for case, poses in zip(cases, placed, strict=True)]
        ours = [score_map(room_map, case.truth) for room_map, case in zip(maps, cases, strict=True)]
        others = {
            name: [score_map(_labelled(peer(c.views, p), c.truth), c.truth) for c, p in zip(cases, placed, strict=True)]
            for name, peer in PEERS.items()
        }
        noise = f"{plans}, pose noise {metres * 100:.0f} cm / {degrees}°"
        found += _rows_at(noise, level, ours, others)
        paths = [_paths(room_map.safety, case) for room_map, case in zip(maps, cases, strict=True)]
        found += _rows_of_paths(noise, paths, [_paths(_inset(case.truth), case) for case in cases])
    return found


def _paths(layer: MultiPolygon, case: Case) -> Paths:
    return paths_on(layer, case.truth.free, case.truth.seen, np.random.default_rng(5))


def _inset(truth: MapTruth) -> MultiPolygon:
    """The safety layer of a perfect map: what the inset alone makes ways longer."""
    return as_polygons(truth.free.buffer(-ReadingSettings().inset, join_style="mitre"))


def _rows_of_paths(noise: str, paths: list[Paths], inset: list[Paths]) -> list[Row]:
    asked, lengths = sum(path.asked for path in paths), np.array([x for path in paths for x in path.lengths])
    note = f"disc of 15 cm on the safety layer, {len(paths)} plans"
    perfect = {"a perfect map's inset": float(np.mean([x for path in inset for x in path.lengths]))}
    return [
        _row(f"{name}, {noise}", value, "", better, (target, peers, asked, note))
        for name, value, better, target, peers in (
            ("paths through a true wall", sum(path.through for path in paths), "lower", 0.0, {}),
            ("paths found", sum(path.found for path in paths) / asked, "higher", None, {}),
            ("length over the true plan's, mean", float(lengths.mean()), "lower", 1.01, perfect),
            ("length over the true plan's, least", float(lengths.min()), "higher", 0.995, {}),
        )
    ]


def _rows_at(noise: str, level: int, ours: list[MapScores], others: dict[str, list[MapScores]]) -> list[Row]:
    """Rows of every measure at one noise level; the means over the plans."""
    table: list[Row] = []
    for name, better in MEASURES.items():
        if not _asked(name, ours):
            continue
        target = TARGETS[name][level] if name in TARGETS else None
        peers = {peer: _mean(name, scores) for peer, scores in others.items()} if name in COMPARED else {}
        note = f"mean of {len(ours)} plans, {VIEWS} lidar views"
        table.append(_row(f"{name}, {noise}", _mean(name, ours), "", better, (target, peers, len(ours), note)))
    return table


def _asked(name: str, scores: list[MapScores]) -> bool:
    """Whether any of the plans names doors or obstacles of its own, for the measures of these."""
    found = next((told for kind, told in NAMED.items() if kind in name), None)
    return found is None or not all(np.isnan(VALUES[found](score)) for score in scores)


NAMED = {"doors": "doors found", "obstacle": "obstacle recall"}
MEASURES = {
    "IoU": "higher", "boundary F1 at 5 cm": "higher", "wall breach": "lower", "chamfer": "lower",
    "worst IoU": "higher", "corner recall": "higher", "doors found": "higher", "doors right": "higher",
    "obstacle recall": "higher", "inferred obstacles right": "higher", "inferred obstacles found": "higher",
    "leaks": "lower", "plans with another number of parts": "lower",
}  # fmt: skip
COMPARED = ("IoU", "boundary F1 at 5 cm", "wall breach", "chamfer")


def _mean(name: str, scores: list[MapScores]) -> float:
    each = np.array([VALUES[name](score) for score in scores], dtype=np.float64)
    return float(each.min() if name.startswith("worst") else np.nansum(each) if name in SUMMED else np.nanmean(each))


VALUES: dict[str, Callable[[MapScores], float]] = {
    "IoU": lambda s: s.iou,
    "worst IoU": lambda s: s.iou,
    "boundary F1 at 5 cm": lambda s: s.boundary.f1_5cm,
    "wall breach": lambda s: s.wall_breach,
    "chamfer": lambda s: s.boundary.chamfer,
    "corner recall": lambda s: s.boundary.corner_recall,
    "doors found": lambda s: s.doors.recall,
    "doors right": lambda s: s.doors.precision,
    "obstacle recall": lambda s: s.obstacles.recall,
    "inferred obstacles right": lambda s: s.obstacles.inferred_precision,
    "inferred obstacles found": lambda s: s.obstacles.inferred_recall,
    "leaks": lambda s: s.leaks,
    "plans with another number of parts": lambda s: s.components != s.true_components,
}
SUMMED = ("leaks", "plans with another number of parts")


def _labelled(free: MultiPolygon, truth: MapTruth) -> RoomMap:
    """A peer's polygons as a map; edges along the truth's own frontier are forgiven, as no peer labels its edges."""
    shadow = truth.seen.boundary.difference(truth.free.boundary.buffer(0.02))
    shapely.prepare(shadow)
    edges = []
    for start, end in boundary_edges(free).tolist():
        near = shadow.dwithin(shapely.Point(0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])), 0.1)
        kind = MapEdgeKind.FRONTIER if near else MapEdgeKind.REAL
        edges.append(MapEdge(tuple(start), tuple(end), kind, 0, 0, 0.0, np.empty(0, dtype=np.int64)))
    return RoomMap(free, free, tuple(edges), (), (), np.empty((0, 2)))


def _by_size() -> list[Row]:
    """Time per view, of reading, memory and order on one large plan with 900 views of 180 beams."""
    rng = np.random.default_rng(9)
    plan = furnished_plan(rng, 24)
    rays = Rays(beams=180, field=np.pi)
    poses = scattered_poses(plan, 900, rng)
    views = [view_of(plan, pose, rays, rng) for pose in poses]
    placed = misplaced(poses, 0.02, 0.3, rng)
    merge_views(views[:20], placed[:20])
    merger, times = Merger(), []
    for index, (view, pose) in enumerate(zip(views, placed, strict=True)):
        start = time.process_time()
        merger.add(view, pose, index)
        times.append(time.process_time() - start)
    start = time.process_time()
    room_map = merger.result()
    reading = time.process_time() - start
    moving = _moved(merger, placed, rng)
    order = rng.permutation(len(views))
    other = merge_views([views[i] for i in order], placed[order])
    apart = room_map.free.symmetric_difference(other.free).area / room_map.free.area
    early, late = float(np.mean(times[:100])) * 1e3, float(np.mean(times[-100:])) * 1e3
    return [
        _row("900 views merged", sum(times) + reading, "s", "lower", (10.0, {}, 1, "adding and reading, one core")),
        _row("adding a view at the end", late, "ms", "lower", (15.0, {}, 100, "its votes counted")),
        _row("time per view, last 100 over first 100", late / early, "", "lower", (1.5, {}, 100, "")),
        _row("moving one of 900 views", moving, "ms", "lower", (15.0, {}, 50, "its votes taken back and cast anew")),
        _row("reading the whole map", reading, "s", "lower", (None, {}, 1, "settled, fused, labelled")),
        _row("memory of the votes", merger.evidence_bytes / 1e6, "MB", "lower", (300.0, {}, 1, "")),
        _row("another order of views: area that differs", 100 * apart, "%", "lower", (0.1, {}, 1, "")),
    ]


def _moved(merger: Merger, poses: NDArray[np.float64], rng: np.random.Generator) -> float:
    """Milliseconds for a view to move by a few centimetres."""
    chosen = rng.choice(len(poses), 50, replace=False)
    start = time.process_time()
    for index in chosen:
        merger.move(int(index), poses[index] + np.array([0.05, -0.03, 0.01]))
    return (time.process_time() - start) / len(chosen) * 1e3


def _row(name: str, value: float, unit: str, better: str, rest: tuple[float | None, dict[str, float], int, str]) -> Row:
    target, peers, runs, note = rest
    return {
        "part": "merging", "name": name, "value": value, "unit": unit, "better": better,
        "target": target, "peers": peers, "runs": runs, "note": note,
    }  # fmt: skip
