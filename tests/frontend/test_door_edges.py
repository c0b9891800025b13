import numpy as np

from frontend.door_edges import DoorEdges, DoorEdgeSettings, DoorEdgeTracks
from frontend.fusion import FusionSettings, fuse
from tests.frontend.test_fusion import FEET, INCH, door_scan

JAMBS = np.array([[6 * FEET, -15 * INCH], [6 * FEET, 15 * INCH]])
SURE = np.diag([0.01, 0.01, 0.005]) ** 2


def tracked(count: int, seed: int = 0) -> DoorEdges:
    rng = np.random.default_rng(seed)
    tracks = DoorEdgeTracks(DoorEdgeSettings())
    for _ in range(count):
        pose = np.array([rng.uniform(-0.5, 0.3), rng.uniform(-0.4, 0.4), 0.0])
        tracks.add(fuse(door_scan(256, (pose[0], pose[1], 0.0))[0], FusionSettings()), pose, SURE)
    return tracks.result


def test_a_jamb_seen_in_several_scans_sharpens() -> None:
    once, often = tracked(1), tracked(8)
    assert often.sightings.max() >= 6
    surest = np.argsort(-often.sightings)[:2]
    assert np.trace(often.covariances[surest[0]]) < 0.4 * np.min(np.trace(once.covariances, axis1=1, axis2=2))
    off = np.linalg.norm(often.positions[surest][:, None] - JAMBS[None], axis=2)
    assert np.all(np.min(off, axis=1) < 0.06)


def test_the_two_jambs_of_a_door_stay_two_tracks() -> None:
    edges = tracked(6)
    surest = np.argsort(-edges.sightings)[:2]
    assert sorted(edges.opens[surest].tolist()) == [False, True]


def test_no_scan_means_no_tracks() -> None:
    assert DoorEdgeTracks(DoorEdgeSettings()).result.positions.shape == (0, 2)
