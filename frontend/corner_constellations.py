"""Where one map of corners lies on another, with hardly a guess: by the largest constellations both have in common."""

from dataclasses import dataclass

import numpy as np

from frontend.constellations import consistent, constellations
from frontend.pair_pose import closed_form
from frontend.rigid_motion import transform, wrap
from frontend.scan import Floats, Integers


@dataclass(frozen=True)
class ConstellationSettings:
    """When corners of two maps form one constellation; lengths in metres, angles in radians."""

    distance_gate: float = 0.15  # two views of one distance between corners may differ by this; larger accepts more
    turn_gate: float = 0.2  # two views of one corner's direction may differ by this; larger accepts more
    alike: float = 0.35  # the same for how far its walls turn; larger confuses different corners
    least: int = 4  # corners in common; larger refuses more
    most_pairs: int = 400  # pairs of corners compared, the rarest kinds first; larger is slower and misses less
    recent: int = 50  # newest keyframes whose corners are laid on old ones; larger has more in common, less sharply
    proposals: int = 3  # poses proposed, of the largest constellations; larger is slower and misses less


@dataclass(frozen=True, eq=False)
class PlacedCorners:
    """Corners in one frame: positions (k, 2), turns (k,), headings (k,) of the bisector to free space."""

    positions: Floats
    turns: Floats
    headings: Floats


def poses_of_corners(
    fixed: PlacedCorners,
    moving: PlacedCorners,
    guess: Floats,
    window: tuple[float, float],
    settings: ConstellationSettings,
) -> list[Floats]:
    """Where a robot truly stands that is believed to stand at `guess` (3,) with the moving corners around it.

    window: metres and radians by which that belief may be wrong. Poses (3,) in the fixed corners' frame, those of
    the largest constellations first.
    """
    pairs, turns = _possible(fixed, moving, guess, window, settings)
    i, j = pairs.T
    graph = consistent(fixed.positions[i], moving.positions[j], turns, settings.distance_gate, settings.turn_gate)
    graph &= (i[:, None] != i[None]) & (j[:, None] != j[None])
    common = sorted((c for c in constellations(graph) if c.size >= settings.least), key=len, reverse=True)
    found: list[Floats] = []
    for constellation in common:
        if len(found) == settings.proposals:
            break
        chosen = pairs[constellation]
        motion = closed_form(fixed.positions[chosen[:, 0]], moving.positions[chosen[:, 1]], turns[constellation])
        pose = np.array([*transform(guess[None, :2], motion)[0], *wrap(guess[2:] + motion[2])])
        if _inside(pose, guess, window) and not any(_inside(pose, other, _SAME) for other in found):
            found.append(pose)
    return found


_SAME = (0.3, 0.1)  # metres and radians within which verification would end at one pose


def _possible(
    fixed: PlacedCorners,
    moving: PlacedCorners,
    guess: Floats,
    window: tuple[float, float],
    settings: ConstellationSettings,
) -> tuple[Integers, Floats]:
    """Pairs (p, 2) of corners that can be one for all that is believed, and the turn (p,) that each asks for."""
    turned = wrap(fixed.headings[:, None] - moving.headings[None])
    apart = np.linalg.norm(fixed.positions[:, None] - moving.positions[None], axis=2)
    arms = np.linalg.norm(moving.positions - guess[:2], axis=1)
    swung = 2 * np.sin(min(window[1], np.pi) / 2) * arms
    alike = np.abs(wrap(fixed.turns[:, None] - moving.turns[None])) < settings.alike
    alike &= np.abs(turned) < window[1] + settings.turn_gate
    alike &= apart < window[0] + swung[None] + settings.distance_gate
    pairs = np.argwhere(alike)
    rarity = alike.sum(axis=1)[pairs[:, 0]] * alike.sum(axis=0)[pairs[:, 1]]
    pairs = pairs[np.sort(np.argsort(rarity, kind="stable")[: settings.most_pairs])]
    return pairs, turned[pairs[:, 0], pairs[:, 1]]


def _inside(pose: Floats, middle: Floats, window: tuple[float, float]) -> bool:
    off = pose - middle
    return bool(np.hypot(*off[:2]) <= window[0] and abs(wrap(off[2])) <= window[1])
