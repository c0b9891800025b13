"""Tracking: where a new scan lies on what was just seen, from odometry and registration."""

from dataclasses import dataclass, field

import numpy as np

from backend.odometry import Move
from frontend.correlative_search import ScoreGrid, SearchSettings
from frontend.local_map import Faces, LocalMap
from frontend.registration import Guess, RegistrationSettings
from frontend.rigid_motion import compose, rotation
from frontend.scan import Floats
from frontend.visibility import VisibilitySettings
from slam.perception import Percept
from slam.unguided import Laid, Looked, Unguided, UnguidedSettings, place_unguided

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
    unguided: UnguidedSettings = field(default_factory=UnguidedSettings)
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
    been taken near here at all, if so. slid: why nothing but the guess says where along a corridor it lies, if so.
    fit: how well it lies there, at most 2.
    """

    pose: Floats
    covariance: Floats
    matched: float
    refused: str | None = None
    astray: str | None = None
    registered: Floats | None = None
    slid: str | None = None
    fit: float = 0.0

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
    looked = Looked(percept, LocalMap.of(faces), settings.registration, settings.visibility)
    prior = Guess(guess, np.asarray(np.linalg.inv(doubt), np.float64))
    window = _window(doubt, settings)
    lost = window[0] > settings.window_sigmas * settings.guided
    best = (
        place_unguided(looked, prior, window, settings.unguided)
        if lost
        else Unguided(_near(looked, prior, window, settings))
    )
    found = best.laid.found
    astray = _astray(percept, best.laid, settings)
    refused = astray or best.refused
    if found.matched < settings.poor and not lost:
        of = f"{found.matched:.0%} of {len(percept.surface.points)} surface points"
        refused = f"only {of} lie on the map ({settings.poor:.0%} needed)"
    if refused is not None:
        return Placed(guess, by_wheels, found.matched, refused, astray or (refused if lost else None))
    both, alone = (
        turned(np.asarray(np.linalg.inv(found.information + other), np.float64), -found.pose_in_fixed[2])
        for other in (prior.information, UNSEEN * np.eye(3))
    )
    # Where nothing else says how far along a corridor the robot went, the graph has to go by what is usual.
    measured = alone if best.slid is None else both
    return Placed(found.pose_in_fixed, both, found.matched, registered=measured, slid=best.slid, fit=best.laid.fit)


def _astray(percept: Percept, laid: Laid, settings: TrackingSettings) -> str | None:
    """What of the map it should have seen, and did not: a scan of another place, not one of new ground."""
    seen, matched = laid.seen, laid.found.matched
    if percept.scan.sensor.half_beam > settings.narrow or seen.visible < settings.judges:
        return None
    if seen.confirmed < settings.astray:
        limit = f"({settings.astray:.0%} needed)"
        return f"{seen.confirmed:.0%} of {seen.visible} visible faces of the map are confirmed {limit}"
    if seen.through > settings.pierced and matched < settings.strange:
        where = f"and only {matched:.0%} of the surface lies on it ({settings.strange:.0%} needed)"
        return f"{seen.through:.0%} of the visible map was seen through (limit {settings.pierced:.0%}), {where}"
    return None


def _doubtful(laid: Laid, settings: TrackingSettings) -> bool:
    """Whether the scan may lie better elsewhere. New ground matches nothing, which alone is no fault."""
    # What does not match may be the very wall that would hold a scan that is free to slide.
    found = laid.found
    slides = found.matched < settings.good and found.firmness < settings.firm
    return slides or laid.seen.confirmed < settings.good or found.matched < settings.poor


def _window(doubt: Floats, settings: TrackingSettings) -> tuple[float, float]:
    """Metres and radians around a guess of this covariance (3, 3) within which a scan is looked for."""
    place, turn = settings.window_sigmas * np.sqrt([np.linalg.eigvalsh(doubt[:2, :2])[-1], doubt[2, 2]])
    return max(float(place), settings.window_metres), min(max(float(turn), settings.window_radians), np.pi)


def _near(looked: Looked, prior: Guess, window: tuple[float, float], settings: TrackingSettings) -> Laid:
    """The scan laid where the guess puts it, or elsewhere in the window where it lies clearly better."""
    laid = looked.lay(prior)
    wide = window[0] > settings.window_metres or window[1] > settings.window_radians
    if not wide and not _doubtful(laid, settings):
        return laid
    search = settings.wide_search if wide else settings.search
    best = ScoreGrid.of(looked.local_map.faces.points, search).search(
        looked.percept.surface.points, prior.pose, window, settings.poor
    )
    if best is None:
        return laid
    there = looked.lay(Guess(prior.pose, prior.information * 0.05), best.pose)
    better = there.found.matched + there.seen.confirmed > laid.found.matched + laid.seen.confirmed + 0.05
    return there if better else laid
