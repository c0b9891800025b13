"""Scores of a trajectory: against true poses (ATE, RPE) and against relations checked by hand.

The relations metric is that of Burgard, Kümmerle et al. 2009: for each pair of times, the error of the estimated
relative pose against the true one. Between scans the pose of the scan before is carried forward by odometry, that of
the scan after backward, and the two are blended by time.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from frontend.rigid_motion import between, compose, wrap
from frontend.scan import Floats


class RelationsError(Exception):
    """A relations file that cannot be read, or that names times outside the trajectory."""


@dataclass(frozen=True)
class Spread:
    """A list of errors in one line."""

    mean: float
    std: float
    median: float
    rmse: float
    worst: float
    count: int

    @classmethod
    def of(cls, errors: Floats) -> "Spread":
        """Summarise errors (n,)."""
        return cls(
            float(np.mean(errors)), float(np.std(errors)), float(np.median(errors)),
            float(np.sqrt(np.mean(errors**2))), float(np.max(errors)), len(errors),
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Track:
    """Poses (n, 3) at times (n,), and the raw odometry (m, 3) at its own times (m,) that joins them."""

    times: Floats
    poses: Floats
    odometry_times: Floats
    odometry: Floats

    def at(self, time: float) -> Floats:
        """The pose (3,) at any time: carried from the scans on both sides by odometry, and blended."""
        before = int(np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, len(self.times) - 1))
        here = self._odometry_at(time)
        forward = compose(self.poses[before], between(self._odometry_at(self.times[before]), here))
        if before + 1 >= len(self.times) or time <= self.times[before]:
            return forward
        backward = compose(self.poses[before + 1], between(self._odometry_at(self.times[before + 1]), here))
        share = (time - self.times[before]) / (self.times[before + 1] - self.times[before])
        return _blend(forward, backward, share)

    def _odometry_at(self, time: float) -> Floats:
        times = self.odometry_times
        before = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, max(len(times) - 2, 0)))
        if len(times) < 2:
            return np.asarray(self.odometry[0])
        share = float(np.clip((time - times[before]) / (times[before + 1] - times[before]), 0, 1))
        return _blend(self.odometry[before], self.odometry[before + 1], share)


def read_relations(path: Path) -> Floats:
    """(r, 5) rows of t1, t2, x, y, yaw from lines `t1 t2 x y z roll pitch yaw`."""
    try:
        lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as reason:
        raise RelationsError(f"{path} cannot be read: {reason.strerror or reason}") from reason
    rows = []
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            t1, t2, x, y, _, _, _, yaw = (float(word) for word in line.split())
        except ValueError as damage:
            raise RelationsError(
                f"{path.name} line {number}: needs 8 numbers t1 t2 x y z roll pitch yaw ({damage})"
            ) from damage
        if not np.isfinite((t1, t2, x, y, yaw)).all():
            raise RelationsError(f"{path.name} line {number}: a number is not finite")
        rows.append((t1, t2, x, y, yaw))
    if not rows:
        raise RelationsError(f"{path.name} holds no relation")
    return np.array(rows)


def relation_errors(track: Track, relations: Floats) -> tuple[Floats, Floats]:
    """Translation errors (r,) in metres, rotation errors (r,) in radians. Raises RelationsError outside the track."""
    first, last = track.times[0], track.times[-1]
    outside = np.flatnonzero((relations[:, :2].min(axis=1) < first - 1) | (relations[:, :2].max(axis=1) > last + 1))
    if len(outside):
        raise RelationsError(
            f"{len(outside)} of {len(relations)} relations lie outside the trajectory's times {first:.2f} to {last:.2f}"
        )
    errors = [between(row[2:], between(track.at(row[0]), track.at(row[1]))) for row in relations]
    return np.array([np.hypot(*error[:2]) for error in errors]), np.array([abs(error[2]) for error in errors])


def nearest_in_time(times: Floats, wanted: Floats, within: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Indices (into times, into wanted) of pairs at most `within` seconds apart, each of `wanted` once."""
    after = np.clip(np.searchsorted(times, wanted), 1, max(len(times) - 1, 1))
    nearest = np.where(
        np.abs(times[after - 1] - wanted) <= np.abs(times[after % len(times)] - wanted), after - 1, after
    )
    nearest = np.minimum(nearest, len(times) - 1)
    kept = np.flatnonzero(np.abs(times[nearest] - wanted) <= within)
    return nearest[kept].astype(np.int64), kept.astype(np.int64)


def align(estimated: Floats, true: Floats) -> Floats:
    """The rigid motion (3,) that lays estimated positions (n, 2) best on the true ones (Umeyama 1991, no scale)."""
    centre, target = estimated.mean(axis=0), true.mean(axis=0)
    covariance = (estimated - centre).T @ (true - target)
    turn = np.arctan2(covariance[0, 1] - covariance[1, 0], covariance[0, 0] + covariance[1, 1])
    cosine, sine = np.cos(turn), np.sin(turn)
    shift = target - np.array([[cosine, -sine], [sine, cosine]]) @ centre
    return np.array([*shift, turn])


def absolute_errors(estimated: Floats, true: Floats) -> Floats:
    """Distances (n,) between positions (n, 2) after the best rigid alignment (absolute trajectory error)."""
    x, y, turn = align(estimated, true)
    cosine, sine = np.cos(turn), np.sin(turn)
    return np.asarray(np.linalg.norm(estimated @ np.array([[cosine, sine], [-sine, cosine]]) + [x, y] - true, axis=1))


def relative_errors(estimated: Floats, true: Floats) -> tuple[Floats, Floats]:
    """Errors (n − 1,) of successive moves in metres and radians, from poses (n, 3) (relative pose error)."""
    moves = [
        between(between(true[i], true[i + 1]), between(estimated[i], estimated[i + 1])) for i in range(len(true) - 1)
    ]
    return np.array([np.hypot(*move[:2]) for move in moves]), np.array([abs(move[2]) for move in moves])


def _blend(first: Floats, second: Floats, share: float) -> Floats:
    offset = second - first
    offset[2] = float(wrap(offset[2]))
    return np.asarray(first + share * offset)
