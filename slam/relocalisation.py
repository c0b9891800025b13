"""Relocalisation: where in an old map a robot stands that knows nothing of its pose.

Constellations of knots propose poses first; then the newest submap is searched over the whole old map (branch and
bound). What is proposed must pass the same test as a loop.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from frontend.correlative_search import ScoreGrid, SearchSettings
from frontend.local_map import Faces
from frontend.matching import MatchingSettings, match_lost
from frontend.rigid_motion import compose, inverse
from frontend.scan import Floats, Integers
from slam.keyframes import Keyframe, around
from slam.loops import Tried, VerificationSettings, close_loop


@dataclass(frozen=True)
class RelocalisationSettings:
    """How a lost robot is looked for."""

    search: SearchSettings = field(default_factory=lambda: SearchSettings(cell=0.1, blur=0.12, levels=7))
    matching: MatchingSettings = field(default_factory=MatchingSettings)
    score: float = 0.55  # of the search; larger refuses more
    piece: int = 200  # keyframes of an old map searched at once; larger is slower and finds sooner
    spacing: float = 1.0  # metres between old keyframes whose knots are compared; larger is faster and misses more
    compared: int = 20  # of them at most, others the next time; larger is slower and misses less
    proposals: int = 3  # constellations verified, the largest first; larger is slower and misses less
    thinned: float = 0.4  # metres between points that are searched with; larger is faster and coarser
    reach: float = 12.0  # metres of the newest submap around the robot
    ahead: float = 1.5  # metres before the robot where views are compared, as for loops


def relocalise(
    recent: Sequence[Keyframe],
    old: Sequence[Keyframe],
    settings: RelocalisationSettings,
    verification: VerificationSettings,
) -> Tried:
    """The last of the recent keyframes laid on the old ones, at least one, by its number among these, or the reason."""
    submap, reasons = Faces.together([keyframe.faces for keyframe in recent]), []
    number = len(old) - 1
    for start in _proposals(recent, submap, old, settings):
        number = nearest_view(start, old, settings.ahead)
        beside = around(old, number, verification.beside, verification.beside)
        there = Faces.together([keyframe.faces for keyframe in beside])
        found = close_loop(recent[-1].percept, start, submap, there, (0.0, 0.0), verification)
        if isinstance(found, str):
            reasons.append(found)
        elif found.firmness < verification.firmness:
            reasons.append(f"free to slide along one direction (firmness {found.firmness:.2f}), and nothing says where")
        else:
            return Tried(number, found)
    return Tried(number, reasons[-1] if reasons else "no constellation of its knots and no place for its surface")


def nearest_view(pose: Floats, keyframes: Sequence[Keyframe], ahead: float) -> int:
    """The keyframe that looks at what a robot at `pose` (3,) looks at."""
    poses = np.array([pose, *(keyframe.pose for keyframe in keyframes)])
    looked = poses[:, :2] + ahead * np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])])
    return int(np.argmin(np.linalg.norm(looked[1:] - looked[0], axis=1)))


def _proposals(
    recent: Sequence[Keyframe], submap: Faces, old: Sequence[Keyframe], settings: RelocalisationSettings
) -> Iterator[Floats]:
    """Poses (3,) in the old map's frame, the cheap ones first."""
    matched = [
        (keyframe, match_lost(keyframe.percept.sketch, recent[-1].percept.sketch, settings.matching))
        for keyframe in _some(_spaced(old, settings.spacing), settings.compared, recent[-1].scan)
    ]
    posed = [
        (len(match.pairs), compose(keyframe.pose, match.pose_in_fixed))
        for keyframe, match in matched
        if match.pose_in_fixed is not None
    ]
    for _, pose in sorted(posed, key=lambda one: -one[0])[: settings.proposals]:
        yield pose
    searched = _searched(submap.moved(inverse(recent[-1].pose)), old, settings)
    if searched is not None:
        yield searched


def _searched(local: Faces, old: Sequence[Keyframe], settings: RelocalisationSettings) -> Floats | None:
    """The best pose (3,) of a submap in its own frame, over the whole old map and all headings."""
    places = Faces.together([keyframe.faces for keyframe in old]).points
    near = local.points[np.linalg.norm(local.points, axis=1) < settings.reach]
    if not len(places) or not len(near):
        return None
    low, high = places.min(axis=0), places.max(axis=0)
    grid = ScoreGrid.of(places[_thinned(places, settings.search.cell)], settings.search)
    middle, window = np.array([*(low + high) / 2, 0.0]), (float(np.max(high - low) / 2), np.pi)
    found = grid.search(near[_thinned(near, settings.thinned)], middle, window, settings.score)
    return None if found is None else found.pose


def _spaced(keyframes: Sequence[Keyframe], spacing: float) -> list[Keyframe]:
    """Those that stand at least so far from the one chosen before them."""
    chosen: list[Keyframe] = []
    for keyframe in keyframes:
        if not chosen or np.hypot(*(keyframe.pose - chosen[-1].pose)[:2]) >= spacing:
            chosen.append(keyframe)
    return chosen


def _some(keyframes: list[Keyframe], count: int, turn: int) -> list[Keyframe]:
    """At most so many, evenly strewn, others at every turn."""
    stride = -(-len(keyframes) // count)
    return keyframes[turn % stride :: stride] if stride > 1 else keyframes


def _thinned(points: Floats, cell: float) -> Integers:
    """One point of each cell."""
    return np.asarray(np.unique(np.floor(points / cell).astype(np.int64), axis=0, return_index=True)[1])
