"""Landmarks: knots seen again from other poses, kept with what tells them apart."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


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
    """Grows by sightings; positions are kept up to date from outside."""

    def __init__(self, settings: LandmarkSettings) -> None:
        self.settings = settings
        self.positions = np.empty((0, 2))
        self._turns = np.empty(0)
        self._headings = np.empty(0)
        self._sightings: list[list[Sighting]] = []

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
        placed = _placed(knots.positions, pose)
        headings = knots.headings + pose[2]
        for k, landmark in enumerate(self._match(placed, knots, headings, pose[2])):
            known = landmark >= 0
            index = int(landmark) if known else self._new(placed[k], knots.turns[k], headings[k])
            seen = self._sightings[index]
            seen.append(Sighting(pose_index, index, knots.positions[k], knots.covariances[k]))
            if len(seen) == self.settings.proven:
                worth.extend(seen)
            elif len(seen) > self.settings.proven:
                worth.append(seen[-1])
        return worth

    def _match(self, placed: Floats, knots: Knots, headings: Floats, turn: float) -> Integers:
        """The landmark (k,) of each knot, or −1; each landmark at most once, the surest first."""
        matches = np.full(len(placed), -1)
        if not len(placed) or not len(self.positions):
            return matches
        cosine, sine = np.cos(turn), np.sin(turn)
        axes = np.array([[cosine, -sine], [sine, cosine]])
        spread = axes @ knots.covariances @ axes.T + self.settings.doubt**2 * np.eye(2)
        offsets = placed[:, None] - self.positions[None]
        distance = np.einsum("kli,kij,klj->kl", offsets, np.linalg.inv(spread), offsets)
        unlike = np.maximum(
            np.abs(_wrapped(knots.turns[:, None] - self._turns[None])),
            np.abs(_wrapped(headings[:, None] - self._headings[None])),
        )
        distance[unlike > self.settings.alike] = np.inf
        for flat in np.argsort(distance, axis=None):
            k, landmark = np.unravel_index(flat, distance.shape)
            if distance[k, landmark] > self.settings.gate:
                break
            if matches[k] < 0 and landmark not in matches:
                matches[k] = landmark
        return matches

    def _new(self, position: Floats, turn: float, heading: float) -> int:
        self.positions = np.vstack([self.positions, position])
        self._turns = np.append(self._turns, turn)
        self._headings = np.append(self._headings, heading)
        self._sightings.append([])
        return len(self._sightings) - 1


def _placed(points: Floats, pose: Floats) -> Floats:
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    return np.asarray(points @ np.array([[cosine, sine], [-sine, cosine]]) + pose[:2])


def _wrapped(angle: Floats) -> Floats:
    return np.asarray(np.arctan2(np.sin(angle), np.cos(angle)))
