"""The pipeline: scans of any iterable become poses and one room map, on a simulated drive and on a real log."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely import Polygon
from shapely.affinity import affine_transform

from backend.room_map import RoomMap
from frontend.rigid_motion import inverse, rotation
from frontend.scan import Floats, Scan
from slam.pipeline import Merged, merge_scans
from slam.recordings import open_recording
from slam.scores.trajectories import read_relations, relation_errors
from slam.settings import Settings
from tests.benchmarks.poses import odometry_of, track_of
from tests.simulated_drives import drive, once_round, round_building

REAL = os.environ.get("ROOMSKETCH_DATA")
with_real_logs = pytest.mark.skipif(REAL is None, reason="ROOMSKETCH_DATA names no folder of real recordings")


@pytest.fixture(scope="module")
def scans() -> list[Scan]:
    return drive(round_building(), once_round(step=0.8), seed=4)


@pytest.fixture(scope="module")
def merged(scans: list[Scan]) -> Merged:
    return merge_scans(scans, Settings())


def in_frame(free: Polygon, pose: Floats) -> Polygon:
    back = inverse(pose)
    turn = rotation(back[2])
    moved = affine_transform(free, [*turn.ravel(), *back[:2]])
    assert isinstance(moved, Polygon)
    return moved


def test_there_is_one_percept_and_one_pose_per_scan(merged: Merged, scans: list[Scan]) -> None:
    assert [percept.scan for percept in merged.percepts] == scans
    assert merged.estimate.poses.shape == (len(scans), 3)
    assert isinstance(merged.room, RoomMap)


def test_the_map_is_the_building(merged: Merged) -> None:
    """The block in the middle stays out, the corridor round it is free: areas agree to a few per cent."""
    true = in_frame(round_building().free, once_round()[0])
    found = merged.room.free
    assert found.intersection(true).area / found.union(true).area > 0.95
    assert any(len(part.interiors) for part in found.geoms)


def test_any_iterable_gives_the_same_bytes(merged: Merged, scans: list[Scan]) -> None:
    streamed = merge_scans((scan for scan in scans), Settings())
    assert streamed.estimate.poses.tobytes() == merged.estimate.poses.tobytes()
    assert streamed.room.free.wkb == merged.room.free.wkb


def test_every_stage_is_timed(merged: Merged) -> None:
    assert set(merged.timings) >= {"front end", "tracking", "loops", "graph", "merging"}
    assert min(merged.timings.values()) >= 0


@with_real_logs
def test_a_real_drive_keeps_the_relations_that_were_checked_by_hand() -> None:
    """The first 150 scans of a log whose wheels turn too much by 3° a metre; the relations' own noise is 2 cm."""
    folder = Path(REAL or "") / "intel"
    recording = open_recording(folder / "intel.log.gz")
    scans = recording.scans[:150]
    result = merge_scans(scans, Settings())
    track = track_of(folder / "intel.log.gz", scans, result.estimate.poses)
    by_wheels = replace(track, poses=odometry_of(scans))
    relations = read_relations(folder / "intel.relations")
    relations = relations[relations[:, :2].max(axis=1) <= track.times[-1]]
    found, _ = relation_errors(track, relations)
    assert len(relations) > 150
    assert np.median(found) < 0.025
    assert np.mean(found) < 0.03
    assert np.mean(relation_errors(by_wheels, relations)[0]) > 1
