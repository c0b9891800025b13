"""Loops: a scan laid on an old submap, believed only when surface, visibility and geometry all agree."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from frontend.correlative_search import ScoreGrid, SearchSettings
from frontend.local_map import Faces, LocalMap
from frontend.registration import Alignment, Guess, RegistrationSettings, register, register_submaps
from frontend.rigid_motion import inverse
from frontend.scan import Floats
from frontend.visibility import VisibilitySettings, look
from slam.perception import Percept
from slam.tracking import turned


@dataclass(frozen=True)
class VerificationSettings:
    """What a loop must show."""

    registration: RegistrationSettings = field(default_factory=RegistrationSettings)
    search: SearchSettings = field(default_factory=SearchSettings)
    visibility: VisibilitySettings = field(default_factory=VisibilitySettings)
    beside: int = 6  # keyframes on either side of the old pose that make the submap; larger gives more overlap
    reach: float = 20.0  # metres of submap around the guess
    close: float = 0.4  # metres of doubt that registration bridges without a search; larger searches less
    score: float = 0.55  # of the correlative search; larger refuses more
    matched: float = 0.75  # share of the scan on the submap; larger refuses more
    confirmed: float = 0.75  # share of the visible submap that the scan confirms; larger refuses more
    through: float = 0.1  # share of it that the scan saw through; smaller refuses more
    residual: float = 0.035  # metres rms, or twice the surface's own spread; smaller refuses more
    firmness: float = 0.05  # smallest over largest information on position; under it, nothing is known along corridors
    slide: float = 1.0  # metres of doubt with which a scan in a corridor may be laid; larger takes another corridor's


@dataclass(frozen=True, eq=False)
class Tried:
    """A loop that was tried from the newest keyframe to an earlier one, by its place in the graph, and its outcome."""

    fixed: int
    found: Alignment | str


# Lays a scan, believed to be at a pose (3,), on old faces, as `close_loop` does.
Verify = Callable[[Percept, Floats, Faces, Faces, tuple[float, float], VerificationSettings], Alignment | str]


def close_loop(
    percept: Percept,
    pose: Floats,
    recent: Faces,
    old: Faces,
    window: tuple[float, float],
    settings: VerificationSettings,
) -> Alignment | str:
    """Lay the scan, now believed to be at `pose` (3,), on old faces; the reason where that is refused.

    recent: faces of the last keyframes, which vote together in a wide search. window: metres and radians.
    """
    if len(percept.surface.points) == 0:
        return "the scan has no surface to lay on the old map"
    start: Floats | None = pose
    if window[0] > settings.close:
        start = _searched(recent, pose, old, window, settings)
    if start is None:
        where = f"within {window[0]:.1f} m and {np.degrees(window[1]):.0f}°"
        return f"no pose {where} puts {settings.score:.0%} of the surface on the old map"
    faces = old.facing(start[:2], settings.reach)
    if len(faces.points) < len(percept.surface.points) / 4:
        return f"only {len(faces.points)} old faces look this way"
    guess = Guess(start, np.zeros((3, 3)))
    found = register(percept.surface, LocalMap.of(faces), guess, settings.registration)
    gone = float(np.hypot(*(found.pose_in_fixed - pose)[:2]))
    if gone > window[0] + settings.close:
        return f"it slid {gone:.1f} m, out of the {window[0] + settings.close:.1f} m in which it can be"
    # In a corridor, the place along it is as doubtful as before.
    held = found if found.firmness >= settings.firmness else found.freed(window[0] + settings.close)
    return _refusal(percept, found, faces, window[0], settings) or held


def _searched(
    recent: Faces, pose: Floats, old: Faces, window: tuple[float, float], settings: VerificationSettings
) -> Floats | None:
    """The best pose of the recent submap on the old one, refined by open3d; None under the score."""
    local = recent.moved(inverse(pose))
    thinned = local.points[:: max(len(local.points) // 400, 1)]
    best = ScoreGrid.of(old.points, settings.search).search(thinned, pose, window, settings.score)
    return None if best is None else register_submaps(local, old, best.pose, settings.close)


def _refusal(
    percept: Percept, found: Alignment, faces: Faces, doubt: float, settings: VerificationSettings
) -> str | None:
    seen = look(percept.fused, found.pose_in_fixed, faces, settings.visibility)
    widest = max(settings.residual, 2 * percept.surface.usual_spread)
    for value, limit, holds, sentence in (
        (found.matched, settings.matched, found.matched >= settings.matched, "of the scan lies on the old map"),
        (
            seen.confirmed,
            settings.confirmed,
            seen.confirmed >= settings.confirmed,
            "of the visible old map is confirmed",
        ),
        (seen.through, settings.through, seen.through <= settings.through, "of the visible old map was seen through"),
    ):
        if not holds:
            return f"{value:.0%} {sentence} (limit {limit:.0%})"
    if found.residual > widest:
        return f"the faces lie {found.residual * 100:.1f} cm apart (limit {widest * 100:.1f} cm)"
    if found.firmness < settings.firmness and doubt > settings.slide:
        firmness = f"firmness {found.firmness:.2f}, limit {settings.firmness:.2f}"
        return f"free to slide along one direction ({firmness}) within {doubt:.1f} m (limit {settings.slide:.1f} m)"
    return None


def loop_covariance(found: Alignment, submap: Floats) -> Floats:
    """(3, 3) of a pose on an old submap, in its own axes. submap: (3, 3) of that submap against its middle pose."""
    own: Floats = np.asarray(np.linalg.inv(found.information + 1e-9 * np.eye(3)), np.float64)
    return np.asarray(turned(own, -found.pose_in_fixed[2]) + submap)
