"""Landmarks: knots seen again from other poses, kept with what tells them apart."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


# What is kept of a landmark: as now believed in the room, and as first seen from a pose.
_ROW = {name: k for k, name in enumerate(("x", "y", "turn", "heading", "own x", "own y", "own heading", "pose"))}


@dataclass(frozen=True)
class LandmarkSettings:
    """When a knot is a landmark seen again."""

    gate: float = 11.8  # squared Mahalanobis distance (χ², 2 degrees of freedom, 0.3 %); larger matches farther off
    doubt: float = 0.05  # metres of placement doubt added to the knot's own; larger matches farther off
    alike: float = 0.35  # radians that turn and heading may differ; larger confuses neighbouring corners
    proven: int = 2  # sightings before a landmark ties poses; larger keeps fewer, surer ones


@dataclass(frozen=True, eq=False)
class Knots:
    """Landmark knots of one scan: positions (k, 2), turns (k,), headings (k,), covariances (k, 2, 2), robot's frame."""

    positions: Floats
    turns: Floats
    headings: Floats
    covariances: Floats


@dataclass(frozen=True, eq=False)
class Sighting:
    """A landmark seen from a pose at a position (2,) of the robot's frame, with covariance (2, 2)."""

    pose: int
    landmark: int
    position: Floats
    covariance: Floats


class LandmarkMap:
    """Grows by sightings; `settle` moves it when poses and proven landmarks were solved again."""

    def __init__(self, settings: LandmarkSettings) -> None:
        self.settings = settings
        self._rows = np.empty((64, len(_ROW)))  # room for more than there are, so that adding copies nothing
        self._sightings: list[list[Sighting]] = []

    @property
    def positions(self) -> Floats:
        """(l, 2) where each landmark is now believed to be."""
        return self._rows[: len(self._sightings), :2]

    @property
    def turns(self) -> Floats:
        """(l,) how far the walls of each turn, counter-clockwise."""
        return self._rows[: len(self._sightings), _ROW["turn"]]

    @property
    def headings(self) -> Floats:
        """(l,) where the bisector of each looks to, into free space."""
        return self._rows[: len(self._sightings), _ROW["heading"]]

    @property
    def first_seen(self) -> Integers:
        """(l,) the pose that saw each of them first."""
        return self._rows[: len(self._sightings), _ROW["pose"]].astype(np.int64)

    @property
    def last_seen(self) -> Integers:
        """(l,) and the pose that did last."""
        return np.array([seen[-1].pose for seen in self._sightings], np.int64)

    @property
    def counts(self) -> Integers:
        """How often each landmark was seen, (l,)."""
        return np.array([len(seen) for seen in self._sightings], np.int64)

    @property
    def unproven(self) -> list[tuple[int, ...]]:
        """The poses that saw a knot which never became a landmark, knot by knot."""
        return [tuple(one.pose for one in seen) for seen in self._sightings if len(seen) < self.settings.proven]

    def see(self, pose_index: int, pose: Floats, knots: Knots) -> list[Sighting]:
        """Match the knots seen at `pose` (3,); the sightings that are worth a factor now (old ones once proven)."""
        worth: list[Sighting] = []
        knots = _with_bearing(knots)
        placed, headings = _placed(knots.positions, pose), knots.headings + pose[2]
        for k, landmark in enumerate(self._match(placed, knots, headings, pose[2])):
            index = int(landmark) if landmark >= 0 else len(self._sightings)
            sighting = Sighting(pose_index, index, knots.positions[k], knots.covariances[k])
            if landmark < 0:
                self._new(sighting, knots.turns[k], knots.headings[k], pose)
            seen = self._sightings[index]
            seen.append(sighting)
            if len(seen) == self.settings.proven:
                worth.extend(seen)
            elif len(seen) > self.settings.proven:
                worth.append(sighting)
        return worth

    def settle(self, poses: Floats, proven: Integers, positions: Floats) -> None:
        """Each landmark moves with the first of poses (n, 3) that saw it; proven ones (p,) are at positions (p, 2)."""
        rows = self._rows[: len(self._sightings)]
        first = poses[rows[:, _ROW["pose"]].astype(np.int64)]
        cosine, sine, own = np.cos(first[:, 2]), np.sin(first[:, 2]), rows[:, 4:6]
        rows[:, 0] = first[:, 0] + cosine * own[:, 0] - sine * own[:, 1]
        rows[:, 1] = first[:, 1] + sine * own[:, 0] + cosine * own[:, 1]
        rows[:, _ROW["heading"]] = rows[:, _ROW["own heading"]] + first[:, 2]
        rows[proven, :2] = positions

    def _match(self, placed: Floats, knots: Knots, headings: Floats, turn: float) -> Integers:
        """The landmark (k,) of each knot, or −1; each landmark at most once, the surest first."""
        matches = np.full(len(placed), -1)
        if not len(placed) or not len(self._sightings):
            return matches
        cosine, sine = np.cos(turn), np.sin(turn)
        axes = np.array([[cosine, -sine], [sine, cosine]])
        spread = axes @ knots.covariances @ axes.T + self.settings.doubt**2 * np.eye(2)
        reach = np.sqrt(self.settings.gate * (spread[:, 0, 0] + spread[:, 1, 1]).max())
        low, high = placed.min(axis=0) - reach, placed.max(axis=0) + reach
        near = np.flatnonzero(np.all((self.positions > low) & (self.positions < high), axis=1))
        rows = self._rows[near]
        offsets = placed[:, None] - rows[None, :, :2]
        distance = np.einsum("kli,kij,klj->kl", offsets, np.linalg.inv(spread), offsets)
        for own, theirs in ((knots.turns, rows[:, 2]), (headings, rows[:, 3])):
            distance[np.abs(_wrapped(own[:, None] - theirs[None])) > self.settings.alike] = np.inf
        possible = np.argwhere(distance <= self.settings.gate)
        for k, j in possible[np.argsort(distance[possible[:, 0], possible[:, 1]], kind="stable")]:
            if matches[k] < 0 and near[j] not in matches:
                matches[k] = near[j]
        return matches

    def _new(self, seen: Sighting, turn: float, heading: float, pose: Floats) -> None:
        """Add a landmark first seen now, from a pose (3,); its turn, and its heading in the robot's frame."""
        if len(self._sightings) == len(self._rows):
            self._rows = np.concatenate([self._rows, np.empty_like(self._rows)])
        position = _placed(seen.position, pose)
        row = (*position, turn, heading + pose[2], *seen.position, heading, seen.pose)
        self._rows[len(self._sightings)] = row
        self._sightings.append([])


def _with_bearing(knots: Knots) -> Knots:
    """Those that are farther away than they are unsure: what may be anywhere around the robot has no bearing."""
    unsure = np.sqrt(np.trace(knots.covariances, axis1=1, axis2=2))
    far = np.hypot(*knots.positions.T) > unsure
    return Knots(knots.positions[far], knots.turns[far], knots.headings[far], knots.covariances[far])


def _placed(points: Floats, pose: Floats) -> Floats:
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    return np.asarray(points @ np.array([[cosine, sine], [-sine, cosine]]) + pose[:2])


def _wrapped(angle: Floats) -> Floats:
    return np.asarray(np.arctan2(np.sin(angle), np.cos(angle)))
