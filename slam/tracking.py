"""Tracking: where a new scan lies on what was just seen, from odometry and registration."""

from dataclasses import dataclass, field

import numpy as np

from backend.odometry import Move
from frontend.correlative_search import ScoreGrid, SearchSettings
from frontend.local_map import Faces, LocalMap
from frontend.registration import Alignment, Guess, RegistrationSettings, register
from frontend.rigid_motion import compose, rotation
from frontend.scan import Floats
from frontend.visibility import Visibility, VisibilitySettings, look
from slam.perception import Percept

UNSEEN = 0.01  # information on a direction that registration does not see: 10 m, 10 rad


@dataclass(frozen=True)
class TrackingSettings:
    """How a scan is placed on the local map."""

    registration: RegistrationSettings = field(default_factory=RegistrationSettings)
    search: SearchSettings = field(default_factory=SearchSettings)
    wide_search: SearchSettings = field(default_factory=lambda: SearchSettings(cell=0.1, blur=0.12))  # of wider windows
    visibility: VisibilitySettings = field(default_factory=VisibilitySettings)
    recent: int = 12  # keyframes in the local map; larger bridges more occlusion and drifts less, at more cost
    reach: float = 20.0  # metres of map around the robot; larger uses far walls
    good: float = 0.8  # confirmed share under which a wider search is tried; larger searches more often
    firm: float = 0.05  # firmness under which a wider search is tried where less than `good` matches; larger does more
    poor: float = 0.4  # matched share under which, after that search, a scan is left to odometry; larger refuses more
    guided: float = 0.3  # metres of doubt beyond which a guess is none, and only registration knows the place
    alone: float = 0.5  # the same as `poor` there; where it knows nothing either, the scan is astray
    window_metres: float = 0.4  # of the wider search; larger finds worse guesses and mistakes more
    window_radians: float = 0.25
    window_sigmas: float = 3.0  # of the guess's doubt that it covers, if that is wider; larger searches longer
    least_faces: int = 8  # surface points a scan needs to be registered at all
    astray: float = 0.5  # confirmed share of the visible map under which a scan is of another place; larger doubts more
    pierced: float = (
        0.25  # share of the visible map seen through that makes it one of another place; larger doubts less
    )
    strange: float = 0.6  # if no more of its own surface lies on the map; larger doubts more
    judges: int = 40  # visible faces that this takes; larger doubts less
    narrow: float = 0.05  # radians of half-beam at most that this takes: a wide beam itself sees past edges


@dataclass(frozen=True, eq=False)
class Placed:
    """Where a scan was put: pose (3,), covariance (3, 3) in its own axes, and why registration was refused, if so.

    registered: (3, 3) covariance of registration alone, without the wheels', which are a measurement of their own.
    matched: what share of the surface found a face, 0 where nothing was registered. astray: why the scan cannot have
    been taken near here at all, if so.
    """

    pose: Floats
    covariance: Floats
    matched: float
    refused: str | None = None
    astray: str | None = None
    registered: Floats | None = None

    @property
    def measured(self) -> Floats:
        """(3, 3) covariance of what only this placement says: registration's, or the guess's where there was none."""
        return self.covariance if self.registered is None else self.registered


def turned(covariance: Floats, angle: float) -> Floats:
    """A pose covariance (3, 3) with its place axes turned by `angle`."""
    axes = np.eye(3)
    axes[:2, :2] = rotation(angle)
    return np.asarray(axes @ covariance @ axes.T)


def track(percept: Percept, last: Floats, move: Move, recent: list[Faces], settings: TrackingSettings) -> Placed:
    """Place a scan after `move` from the pose `last` (3,) on the recent faces."""
    guess = compose(last, move.pose)
    doubt = turned(move.covariance, last[2])
    by_wheels = turned(doubt, -guess[2])
    faces = (
        Faces.together(recent).facing(guess[:2], settings.reach)
        if recent
        else Faces(np.empty((0, 2)), np.empty((0, 2)))
    )
    if min(len(faces.points), len(percept.surface.points)) < settings.least_faces:
        few = (
            f"{len(percept.surface.points)} surface points against {len(faces.points)} on the map: too few to register"
        )
        return Placed(guess, by_wheels, 0.0, few)
    local_map = LocalMap.of(faces)
    prior = Guess(guess, np.asarray(np.linalg.inv(doubt), np.float64))
    window = _window(doubt, settings)
    wide = window[0] > settings.window_metres or window[1] > settings.window_radians
    lost = window[0] > settings.window_sigmas * settings.guided
    found = register(percept.surface, local_map, prior, settings.registration)
    seen = look(percept.fused, found.pose_in_fixed, faces, settings.visibility)
    if wide or _doubtful(found, seen, settings):
        found, seen = _wider(percept, local_map, prior, (found, seen), window, settings)
    astray = _astray(percept, found.matched, seen, settings)
    needed = settings.alone if lost else settings.poor
    if found.matched < needed:
        reason = (
            f"only {found.matched:.0%} of {len(percept.surface.points)} surface points lie on the map "
            f"({needed:.0%} needed)"
        )
        return Placed(guess, by_wheels, found.matched, reason, astray or (reason if lost else None))
    if astray is not None:
        return Placed(guess, by_wheels, found.matched, astray, astray)
    if lost and found.firmness < settings.firm:
        found = found.freed(window[0])
    both, alone = (
        turned(np.asarray(np.linalg.inv(found.information + other), np.float64), -found.pose_in_fixed[2])
        for other in (prior.information, UNSEEN * np.eye(3))
    )
    return Placed(found.pose_in_fixed, both, found.matched, registered=alone)


def _astray(percept: Percept, matched: float, seen: Visibility, settings: TrackingSettings) -> str | None:
    """What of the map it should have seen, and did not: a scan of another place, not one of new ground."""
    if percept.scan.sensor.half_beam > settings.narrow or seen.visible < settings.judges:
        return None
    if seen.confirmed < settings.astray:
        limit = f"({settings.astray:.0%} needed)"
        return f"{seen.confirmed:.0%} of {seen.visible} visible faces of the map are confirmed {limit}"
    if seen.through > settings.pierced and matched < settings.strange:
        where = f"and only {matched:.0%} of the surface lies on it ({settings.strange:.0%} needed)"
        return f"{seen.through:.0%} of the visible map was seen through (limit {settings.pierced:.0%}), {where}"
    return None


def _doubtful(found: Alignment, seen: Visibility, settings: TrackingSettings) -> bool:
    """Whether the scan may lie better elsewhere. New ground matches nothing, which alone is no fault."""
    # What does not match may be the very wall that would hold a scan that is free to slide.
    slides = found.matched < settings.good and found.firmness < settings.firm
    return slides or seen.confirmed < settings.good or found.matched < settings.poor


def _window(doubt: Floats, settings: TrackingSettings) -> tuple[float, float]:
    """Metres and radians around a guess of this covariance (3, 3) within which a scan is looked for."""
    place, turn = settings.window_sigmas * np.sqrt([np.linalg.eigvalsh(doubt[:2, :2])[-1], doubt[2, 2]])
    return max(float(place), settings.window_metres), min(max(float(turn), settings.window_radians), np.pi)


def _wider(
    percept: Percept,
    local_map: LocalMap,
    prior: Guess,
    so_far: tuple[Alignment, Visibility],
    window: tuple[float, float],
    settings: TrackingSettings,
) -> tuple[Alignment, Visibility]:
    """Search a window around the guess, and keep the better of both answers."""
    search = settings.search if window[0] <= settings.window_metres else settings.wide_search
    best = ScoreGrid.of(local_map.faces.points, search).search(
        percept.surface.points, prior.pose, window, settings.poor
    )
    if best is None:
        return so_far
    weak = Guess(prior.pose, prior.information * 0.05)
    found = register(percept.surface, local_map, weak, settings.registration, start=best.pose)
    seen = look(percept.fused, found.pose_in_fixed, local_map.faces, settings.visibility)
    better = found.matched + seen.confirmed > so_far[0].matched + so_far[1].confirmed + 0.05
    return (found, seen) if better else so_far
