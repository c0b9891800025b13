"""Where a scan lies when nothing guides it: each heading's best place is tried, and what no wall holds is said.

A search that keeps one answer takes the wrong arm of a crossing. Here every sector of headings has its own best place,
all are laid and judged by what the scan confirms and contradicts, and only one that stands out is believed. Along a
corridor the place is then moved as far as it fits as well: what is left between is known by nothing but the guess.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from frontend.correlative_search import ScoreGrid, SearchSettings
from frontend.local_map import Faces, LocalMap
from frontend.registration import Alignment, Guess, RegistrationSettings, register
from frontend.rigid_motion import between
from frontend.scan import Floats
from frontend.visibility import Visibility, VisibilitySettings, look
from slam.perception import Percept

ALIKE = 7  # neighbouring readings share one line fit, and are worth one
JUDGES = 40  # visible faces that this takes to judge a place by them
NEAR = 0.6  # metres to a face within which surface lies on mapped ground
PINNED = 1e6  # information on a place that registration may not move along


@dataclass(frozen=True)
class UnguidedSettings:
    """How a scan is looked for without a guess to go by."""

    search: SearchSettings = field(default_factory=lambda: SearchSettings(cell=0.1, blur=0.12))
    voters: int = 80  # surface points that take part in the search; larger is slower and sees smaller things
    score: float = 0.25  # of the search; larger is faster and gives up new ground
    sector: float = 0.25  # radians to each side that are searched as one; larger is faster and sees fewer rivals
    # In its place a scan reaches 1.5 of 2 in 99 of 100 cases. Elsewhere the best of a window of 1.5 m reaches 1.0 in 40
    # and 1.4 in 13 of 100, that of a window of 3 m 1.4 in 22 (Intel's corridors): more is needed where more was tried.
    believed: float = 1.0  # least fit in a window of `believed_metres`; larger gives up where much ground is new
    believed_metres: float = 1.5
    certain: float = 1.6  # fit for which wheels that were never right before are wrong; 4 in 100 reach it elsewhere
    sure: float = 1.4  # fit over which little more could be known of a place; larger asks more often
    rise: float = 0.4  # of that for each doubling of the window; larger gives up sooner where the robot was lost
    surer: float = 9.2  # squared Mahalanobis distance (χ², 2 degrees of freedom, 1 %) by which the guess decides
    apart_metres: float = 0.4  # between two answers that are two places; larger sees fewer rivals
    apart_radians: float = 0.2
    slide: float = 0.2  # metres between places tried along a corridor; larger is faster and coarser
    known: float = 0.6  # metres of corridor within which a place counts as known; larger says less often that it is not
    firm: float = 0.2  # firmness over which nothing slides; larger is slower and says more often that it does


@dataclass(frozen=True, eq=False)
class Laid:
    """A scan laid on a local map, and what it sees from there.

    readings: of its surface; on: how many lie on the lines of faces, off: how many beside them. The others lie on new
    ground, which says nothing.
    """

    found: Alignment
    seen: Visibility
    readings: int
    on: int
    off: int

    @property
    def held(self) -> float:
        """What of the map is confirmed, less what was seen through; a few visible faces say little."""
        return (self.seen.confirmed - self.seen.through) * min(self.seen.visible / JUDGES, 1.0)

    @property
    def fit(self) -> float:
        """What of the scan lies on the map, and what of the map it holds: at most 2."""
        return self.on / max(self.readings, 1) + self.held

    @property
    def against(self) -> float:
        """How many readings say that this is not the place: surface beside the map's, faces that should be there."""
        return self.off + (1 - self.seen.confirmed) * min(self.seen.visible, self.readings)

    def beats(self, other: "Laid") -> bool:
        """Whether it fits better than another by more than one line fit: of the scan's readings, or of faces."""
        visible = max(min(self.seen.visible, other.seen.visible), 1)
        return self.on - other.on + (self.held - other.held) * visible > ALIKE


@dataclass(frozen=True, eq=False)
class Unguided:
    """The best place of a scan; why it is none, if another is as good; how it could slide, if it could."""

    laid: Laid
    refused: str | None = None
    slid: str | None = None


@dataclass(frozen=True, eq=False)
class Looked:
    """A scan, and the local map on which it is looked for."""

    percept: Percept
    local_map: LocalMap
    registration: RegistrationSettings
    visibility: VisibilitySettings

    def lay(self, guess: Guess, start: Floats | None = None) -> Laid:
        """The scan pulled onto the map from there, or from another start (3,)."""
        found = register(self.percept.surface, self.local_map, guess, self.registration, start)
        seen = look(self.percept.fused, found.pose_in_fixed, self.local_map.faces, self.visibility)
        placed = Faces.placed(self.percept.surface, found.pose_in_fixed)
        covered, on = self.local_map.lying(placed, NEAR, self.registration.distances[-1])
        return Laid(found, seen, len(on), int(on.sum()), int((covered & ~on).sum()))


def place_unguided(looked: Looked, guess: Guess, window: tuple[float, float], settings: UnguidedSettings) -> Unguided:
    """The place of a scan within `window`, metres and radians, around a guess."""
    laid = [looked.lay(start) for start in _starts(looked, guess, window, settings)]
    # The first is the guess itself, which is an answer where it stayed in the window like any other.
    inside = [one for one in laid if _inside(one, guess, window)] or laid[:1]
    best = max(inside, key=lambda one: one.fit)
    alike = [one for one in inside if not best.beats(one)]
    best = min(alike, key=lambda one: _surprise(guess, one))
    needed = settings.believed + settings.rise * max(np.log2(window[0] / settings.believed_metres), 0.0)
    if best.fit < needed:
        matched, confirmed = (
            f"{best.on / max(best.readings, 1):.0%} of it lies on the map",
            f"{best.seen.confirmed:.0%} confirmed",
        )
        limit = f"{best.fit:.2f} in all, {needed:.2f} needed"
        return Unguided(best, f"{matched}, {confirmed} and {best.seen.through:.0%} of that seen through ({limit})")
    for rival in alike:
        if _apart(best, rival, settings) and _surprise(guess, rival) - _surprise(guess, best) < settings.surer:
            off = between(best.found.pose_in_fixed, rival.found.pose_in_fixed)
            where = f"{np.hypot(*off[:2]):.1f} m and {np.degrees(off[2]):.0f}° beside its best place"
            return Unguided(best, f"the scan lies as well {where}")
    if best.found.firmness > settings.firm:
        return Unguided(best)
    return _slid(looked, best, guess, window[0], settings)


def _inside(laid: Laid, guess: Guess, window: tuple[float, float]) -> bool:
    """Whether an answer lies in the window but for how far it slid along its corridor."""
    off, along = laid.found.pose_in_fixed - guess.pose, _along(laid.found)
    aside = abs(float(off[0] * along[1] - off[1] * along[0]))
    return aside < window[0] and abs(np.arctan2(np.sin(off[2]), np.cos(off[2]))) < window[1]


def _surprise(guess: Guess, laid: Laid) -> float:
    """Squared Mahalanobis distance of an answer from the guess."""
    off = laid.found.pose_in_fixed - guess.pose
    off[2] = np.arctan2(np.sin(off[2]), np.cos(off[2]))
    return float(off @ guess.information @ off)


def _starts(looked: Looked, guess: Guess, window: tuple[float, float], settings: UnguidedSettings) -> Sequence[Guess]:
    """The guess, and the best place of every sector of headings; nothing pulls back from there."""
    free = np.zeros((3, 3))
    grid = ScoreGrid.of(looked.local_map.faces.points, settings.search)
    points = looked.percept.surface.points
    points = points[:: max(len(points) // settings.voters, 1)]
    half = settings.sector
    count = int(np.ceil(window[1] / half))
    starts = [Guess(guess.pose, free)]
    for turn in half * (2 * np.arange(count) + 1 - count):
        centre = guess.pose + np.array([0.0, 0.0, turn])
        found = grid.search(points, centre, (window[0], half), settings.score)
        if found is not None:
            starts.append(Guess(found.pose, free))
    return starts


def _apart(best: Laid, other: Laid, settings: UnguidedSettings) -> bool:
    """Whether two answers are two places, and not one that slides along its corridor."""
    off = between(best.found.pose_in_fixed, other.found.pose_in_fixed)
    if abs(off[2]) > settings.apart_radians:
        return True
    along = _along(best.found)
    place = (other.found.pose_in_fixed - best.found.pose_in_fixed)[:2]
    return bool(np.hypot(*(place - (place @ along) * along)) > settings.apart_metres)


def _along(found: Alignment) -> Floats:
    """The direction (2,) in which the place is known least."""
    return np.asarray(np.linalg.eigh(found.information[:2, :2])[1][:, 0])


def _slid(looked: Looked, best: Laid, guess: Guess, reach: float, settings: UnguidedSettings) -> Unguided:
    """The best place along the line on which one is known least, or the guess's where the scan fits all along it."""
    along, pose = _along(best.found), best.found.pose_in_fixed
    axis = np.array([*along, 0.0])
    pin = PINNED * np.outer(axis, axis)
    # From the guess, not from the best place: a scan that is free to slide may have slid out of the window.
    guessed, count = float(along @ (guess.pose - pose)[:2]), int(reach / settings.slide)
    shifts = guessed + settings.slide * np.arange(-count, count + 1)
    laid = [looked.lay(Guess(pose + shift * axis, pin)) for shift in shifts]
    if abs(guessed) < reach:
        shifts, laid = np.append(shifts, 0.0), [*laid, best]
    firmest = max(laid, key=lambda one: one.fit)
    # New ground lies ahead: a scan lies best on the map a little behind its place, but nothing contradicts the place.
    fitting = np.array(
        [not firmest.beats(one) or (one.fit > settings.sure and one.against <= firmest.against + ALIKE) for one in laid]
    )
    length = float(np.ptp(shifts[fitting]))
    nearest = int(np.argmin(np.where(fitting, np.abs(shifts - guessed), np.inf)))
    if length > settings.known:
        where = f"it fits as well along {length:.1f} m, and lies where the robot would be if it went on as before"
        held = replace(laid[nearest], found=laid[nearest].found.freed(length / np.sqrt(12)))
        return Unguided(held, slid=f"along the corridor nothing is known: {where}")
    there = looked.lay(Guess(firmest.found.pose_in_fixed, np.zeros((3, 3))))
    return Unguided(replace(there, found=there.found.freed(max(length, settings.slide) / np.sqrt(12))))
