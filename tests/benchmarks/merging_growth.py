"""A map that grows: what a look at it costs once it was read, and how it differs from merging everything anew."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from backend.polygon_merging import Merger, merge_views
from backend.room_map import RoomMap
from backend.view import View
from tests.backend.plan_rays import Rays, furnished_plan, misplaced, scattered_poses, view_of

Floats = NDArray[np.float64]
Row = dict[str, Any]
VIEWS, LOOKS, MOVED = 900, 5, (10, 50)


def rows() -> list[Row]:
    """All rows of the part: 24 rooms, 900 views of 180 beams, of which the last five come one by one."""
    rng = np.random.default_rng(9)
    plan = furnished_plan(rng, 24)
    true = scattered_poses(plan, VIEWS, rng)
    views = [view_of(plan, pose, Rays(beams=180, field=np.pi), rng) for pose in true]
    poses = misplaced(true, 0.02, 0.3, rng)
    merge_views(views[:20], poses[:20])
    merger = Merger()
    for index in range(VIEWS - LOOKS):
        merger.add(views[index], poses[index], index)
    first = _seconds(merger.result)
    looks = []
    for index in range(VIEWS - LOOKS, VIEWS):
        merger.add(views[index], poses[index], index)
        looks.append(_seconds(merger.result))
    found = [
        _row("reading the map of 895 views for the first time", first, "s", 1),
        _row("reading it again after one more view, median", float(np.median(looks)), "s", LOOKS),
        _row(
            "area that differs from merging all anew, after these", _apart(merger.result(), views, poses), "%", 1, 0.1
        ),
    ]
    for count in MOVED:
        start = int(rng.integers(VIEWS - count))
        poses[start : start + count] += np.array([0.03, -0.02, 0.004])
        for index in range(start, start + count):
            merger.move(index, poses[index])
        found += [
            _row(f"reading it after {count} views moved", _seconds(merger.result), "s", 1),
            _row(f"area that differs, after {count} moved", _apart(merger.result(), views, poses), "%", 1, 0.1),
        ]
    return found


def _seconds(look: Callable[[], RoomMap]) -> float:
    start = time.process_time()
    look()
    return time.process_time() - start


def _apart(room_map: RoomMap, views: list[View], poses: Floats) -> float:
    """Per cent of the area by which the map differs from that of a merger that sees everything for the first time."""
    fresh = merge_views(views, poses)
    return 100 * float(room_map.free.symmetric_difference(fresh.free).area / fresh.free.area)


def _row(name: str, value: float, unit: str, runs: int, target: float | None = None) -> Row:
    return {
        "part": "merging", "name": name, "value": value, "unit": unit, "better": "lower",
        "target": target, "peers": {}, "runs": runs, "note": "",
    }  # fmt: skip
