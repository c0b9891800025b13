"""Merging of logs: sonar and infrared at true poses, and the Intel building at the poses of our own back end."""

import os
import time
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely.geometry.base import BaseGeometry

from backend.leak_repair import FaceBins, supported_bins
from backend.polygon_merging import Merger, MergeSettings, merge_views
from backend.samples import Samples
from backend.surfaces import surfaces_of
from backend.view import View
from backend.wall_faces import FaceSettings, fuse_faces
from slam.mapper import Mapper
from slam.perception import FrontendSettings, perceive
from slam.recordings import open_recording
from slam.room_file import free_space
from slam.scores.maps import MapTruth, score_map
from slam.scores.results import overlap, raw_free_space, visible
from slam.settings import Settings, knowing
from slam.trajectory_file import read_trajectory
from tests.benchmarks.merging_peers import plain_union

Floats = NDArray[np.float64]
Row = dict[str, Any]
DATASETS = Path(__file__).parents[2] / "datasets"
SONAR = {"flynn_basement": 0.80, "apartment": 0.93}
THICKEST, BESIDE = 0.40, 0.10  # metres: of a two-sided wall, and of free ground asked for on both sides of a hole in it


def rows() -> list[Row]:
    """All rows of the part; the Intel log is read from the folder that ROOMSKETCH_DATA names."""
    sonar = [row for name, target in SONAR.items() for row in _sonar(name, target)]
    return [*sonar, *_intel()] if "ROOMSKETCH_DATA" in os.environ else sonar


def _sonar(name: str, target: float) -> list[Row]:
    recording, true = open_recording(DATASETS / name), read_trajectory(DATASETS / name / "true.tum").poses
    plan, _ = free_space(DATASETS / name / "truth.geojson", "free")
    seen = visible(plan, true, recording.scans[0].sensor.max_range)
    room = merge_views([perceive(scan, FrontendSettings()).view for scan in recording.scans], true)
    scores = score_map(room, MapTruth(plan, seen, np.empty((0, 2, 2)), ()))
    raw = {"raw sonar boundaries": overlap(raw_free_space(recording.scans, true), seen)}
    return [
        _row(f"{name} at true poses: IoU", scores.iou, "", "higher", (target, raw)),
        _row(f"{name} at true poses: wall breach", scores.wall_breach, "", "lower", (0.02, {})),
        _row(f"{name} at true poses: false free", scores.false_free, "m²", "lower", (None, {})),
    ]


def _intel() -> list[Row]:
    recording = open_recording(Path(os.environ["ROOMSKETCH_DATA"]) / "intel" / "intel.log.gz")
    settings = knowing(Settings(), recording.odometry_noise)
    mapper = Mapper(settings.frontend, settings.poses)
    for scan in recording.scans:
        mapper.add(scan)
    views, poses = [percept.view for percept in mapper.percepts], mapper.result().poses
    merge_views(views[:20], poses[:20])
    merger, times = Merger(), []
    for index, (view, pose) in enumerate(zip(views, poses, strict=True)):
        start = time.process_time()
        merger.add(view, pose, index)
        times.append(time.process_time() - start)
    start = time.process_time()
    room = merger.result()
    reading = time.process_time() - start
    bins = _bins(views, poses)
    opened = {"plain union": _open_share(plain_union(views, poses), bins)}
    late, early = float(np.mean(times[-100:])), float(np.mean(times[:100]))
    return [
        _row("Intel: 910 views merged", sum(times) + reading, "s", "lower", (10.0, {})),
        _row("Intel: adding a view at the end", 1e3 * late, "ms", "lower", (15.0, {})),
        _row("Intel: time per view, last 100 over first 100", late / early, "", "lower", (1.5, {})),
        _row("Intel: two-sided walls left open", _open_share(room.free, bins), "", "lower", (0.01, opened)),
        _row("Intel: leak alarms", len(room.leaks), "", "lower", (None, {})),
        _row("Intel: leak alarms without a reason", len(room.leaks) - len(room.leak_reasons), "", "lower", (0.0, {})),
    ]


def _bins(views: list[View], poses: Floats) -> FaceBins:
    """Pieces of wall that two views or more measured, at the poses given."""
    opinions = MergeSettings()
    parts = [surfaces_of(view, opinions.piece, opinions.finest) for view in views]
    local = Samples(
        np.concatenate([part.ring[part.corner] for part in parts]),
        np.concatenate([part.normals for part in parts]),
        np.repeat(np.arange(len(parts)), [len(part.corner) for part in parts]),
        np.concatenate([part.sigma for part in parts]),
        np.concatenate([part.weight for part in parts]),
        np.concatenate([part.sure for part in parts]),
    )
    placed = local.placed(poses)
    return supported_bins(placed, fuse_faces(placed, FaceSettings()))


def _open_share(free: BaseGeometry, bins: FaceBins) -> float:
    """Share of two-sided wall pieces whose crossing, with 10 cm on both sides, is wholly free."""
    ahead, behind = bins.middles, bins.normals
    pairs = cKDTree(ahead).query_pairs(THICKEST, output_type="ndarray")
    gap = ahead[pairs[:, 1]] - ahead[pairs[:, 0]]
    depth = -np.sum(gap * behind[pairs[:, 0]], axis=1)
    aside = np.abs(gap[:, 0] * behind[pairs[:, 0], 1] - gap[:, 1] * behind[pairs[:, 0], 0])
    opposite = np.sum(behind[pairs[:, 0]] * behind[pairs[:, 1]], axis=1) < -0.95
    pairs = pairs[opposite & (depth > 0.02) & (aside < 0.05)]
    start, out = ahead[pairs[:, 0]], BESIDE * behind[pairs[:, 0]]
    crossings = shapely.linestrings(np.stack([start + out, ahead[pairs[:, 1]] - out], axis=1))
    shapely.prepare(free)
    return float(np.mean(shapely.covers(free, crossings)))


def _row(name: str, value: float, unit: str, better: str, rest: tuple[float | None, dict[str, float]]) -> Row:
    target, peers = rest
    return {
        "part": "merging", "name": name, "value": value, "unit": unit, "better": better,
        "target": target, "peers": peers, "runs": 1, "note": "",
    }  # fmt: skip
