"""Door edges tracked over scans: a jamb that several scans see sharpens (a Kalman filter each, from filterpy).

One scan knows the bearing of a jamb to a part of a bearing step and its range to the sonar's noise; both shrink as more
scans see the same jamb from elsewhere.
"""

from dataclasses import dataclass

import numpy as np
from filterpy.kalman import KalmanFilter
from scipy.optimize import linear_sum_assignment
from scipy.stats import chi2

from frontend.fusion import FusedScan
from frontend.rigid_motion import rotation, transform
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True)
class DoorEdgeSettings:
    """Opinions of the tracks."""

    confidence: float = 0.99  # of the gate in which a jamb continues a track; larger joins more distant sightings
    range_doubt: float = 0.08  # metres, what the beam leaves of a jamb's range; larger trusts bearings more
    reveal: float = (
        0.08  # metres, half a wall: its near or far corner is seen, as one looks; larger trusts bearings less
    )


@dataclass(frozen=True, eq=False)
class DoorEdges:
    """Tracked jambs: positions (t, 2), covariances (t, 2, 2), opens (t,) as seen, sightings (t,)."""

    positions: Floats
    covariances: Floats
    opens: Booleans
    sightings: Integers


class DoorEdgeTracks:
    """Jambs that grow surer with every scan added."""

    def __init__(self, settings: DoorEdgeSettings) -> None:
        self._settings = settings
        self._filters: list[KalmanFilter] = []
        self._opens: list[bool] = []
        self._sightings: list[int] = []

    def add(self, fused: FusedScan, pose: Floats, pose_covariance: Floats) -> Integers:
        """The jambs of one scan, placed by the pose (3,) and its covariance (3, 3), both in one frame for all scans.

        The track (2 d,) that each right and left jamb of the scan's d openings continues or begins.
        """
        jambs, doubts = jamb_sightings(fused, pose, pose_covariance, self._settings)
        opens = np.tile([True, False], len(fused.openings))
        chosen = self._continued(jambs, doubts, opens)
        for sighting, track in enumerate(chosen):
            if track is None:
                chosen[sighting] = self._start(jambs[sighting], doubts[sighting], bool(opens[sighting]))
            else:
                self._filters[track].update(jambs[sighting], R=doubts[sighting])
                self._sightings[track] += 1
        return np.array(chosen, dtype=np.int64)

    @property
    def result(self) -> DoorEdges:
        """The tracks so far."""
        return DoorEdges(
            np.array([track.x for track in self._filters]).reshape(-1, 2),
            np.array([track.P for track in self._filters]).reshape(-1, 2, 2),
            np.array(self._opens, dtype=bool),
            np.array(self._sightings, dtype=np.int64),
        )

    def _start(self, jamb: Floats, doubt: Floats, opens: bool) -> int:
        track = KalmanFilter(dim_x=2, dim_z=2)
        track.x, track.P, track.H = jamb, doubt, np.eye(2)
        track.Q, track.F = np.zeros((2, 2)), np.eye(2)  # jambs stand still
        self._filters.append(track)
        self._opens.append(opens)
        self._sightings.append(1)
        return len(self._filters) - 1

    def _continued(self, jambs: Floats, doubts: Floats, opens: Booleans) -> list[int | None]:
        """The track each sighting continues: the assignment of least distance with every pair in the gate."""
        chosen: list[int | None] = [None] * len(jambs)
        if not len(jambs) or not self._filters:
            return chosen
        tracks = self.result
        off = jambs[:, None] - tracks.positions[None]
        spread = np.linalg.inv(doubts[:, None] + tracks.covariances[None])
        distances = np.einsum("sti,stij,stj->st", off, spread, off)
        gate = float(chi2.ppf(self._settings.confidence, 2))
        distances[(distances > gate) | (opens[:, None] != tracks.opens[None])] = 1e6
        for sighting, track in zip(*linear_sum_assignment(distances), strict=True):
            if distances[sighting, track] <= gate:
                chosen[sighting] = int(track)
        return chosen


def jamb_sightings(
    fused: FusedScan, pose: Floats, covariance: Floats, settings: DoorEdgeSettings
) -> tuple[Floats, Floats]:
    """Placed jambs (s, 2) of one scan, and their covariances (s, 2, 2): of bearing, range, reveal and the pose."""
    local = fused.jambs.reshape(-1, 2)
    beams = local - fused.origin
    reach = np.linalg.norm(beams, axis=1)
    along = beams / np.maximum(reach, 1e-9)[:, None]
    aside = np.column_stack([-along[:, 1], along[:, 0]])
    step = float(np.median(np.diff(fused.bearings)))
    deep = settings.range_doubt**2 + float(np.median(fused.spread)) ** 2
    wide = (reach * step) ** 2 / 12 + settings.reveal**2
    seen = deep * along[:, :, None] * along[:, None] + wide[:, None, None] * aside[:, :, None] * aside[:, None]
    turn = rotation(pose[2])
    slopes = np.zeros((len(local), 2, 3))
    slopes[:, :, :2] = np.eye(2)
    slopes[:, :, 2] = local @ turn.T @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    return transform(local, pose), turn @ seen @ turn.T + slopes @ covariance @ np.swapaxes(slopes, 1, 2)
