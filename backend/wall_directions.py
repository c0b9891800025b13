"""Wall directions: buildings run in few directions and those at right angles to them, and views turn along with these.

A view that shares little surface with the others has only its pose's word for its heading, and a wall five metres off
moves by a decimetre with one degree. Directions are sought in all views at once, and none where surfaces face
everywhere alike; which way they point is eliminated like the lines that views share, so all views turn freely together.

How well a wall's angle is known, by its length and its view's heading, says how sharply directions are told apart and
how far off one a wall may stand to run in it: a wing that is one degree askew is no part of the rest.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from backend.samples import Samples
from backend.shared_lines import Shared

Floats = NDArray[np.float64]
SQUARE = 0.5 * np.pi
BINS = 720  # of a quarter turn
SPREADS = np.array([2.0, 4.0, 8.0, 16.0, 32.0])  # bins: classes of standard errors, from a quarter of a degree to four


@dataclass(frozen=True)
class DirectionSettings:
    """Opinions about the directions in which a building's walls run."""

    askew: float = (
        0.012  # radians a metre of wall may stand off the building's directions; larger believes in them less
    )
    apart: float = 2.0  # standard errors off a direction from which a wall is not in it; larger bends wings less askew
    outstanding: float = 8.0  # times an even spread of surface; larger finds directions in fewer buildings


def angle_errors(local: Samples, independent: float) -> tuple[Floats, Floats]:
    """Standard error (n,) of the angle of the straight piece of surface that each sample lies on, and the length (n,)
    of that piece: radians and metres.

    A line fitted to what measures a piece of length L with noise σ, once every `independent` metres, turns by
    σ √(12 independent / L) / L.
    """
    facing, view = local.normals, local.view
    ends = np.any(facing[1:] != facing[:-1], axis=1) | (view[1:] != view[:-1])
    piece = np.concatenate([np.zeros(min(len(view), 1), dtype=np.int64), np.cumsum(ends)])
    length = np.maximum(np.bincount(piece, local.weight), independent)[piece]
    return local.sigma * np.sqrt(12 * independent / length) / length, length


def wall_directions(normals: Floats, weight: Floats, errors: Floats, outstanding: float) -> Floats:
    """Directions (d,) in 0…π/2 in which, or square to which, outstandingly much of the surface faces.

    Each sample counts around its angle as widely as that may be wrong: errors (n,), radians.
    """
    place = ((np.arctan2(normals[:, 1], normals[:, 0]) % SQUARE) / SQUARE * BINS).astype(np.int64) % BINS
    kind = np.searchsorted(SPREADS[:-1], errors / SQUARE * BINS)
    faced = np.bincount(kind * BINS + place, weight, len(SPREADS) * BINS).reshape(-1, BINS)
    spread = zip(faced, SPREADS, strict=True)
    smooth = np.sum([ndimage.gaussian_filter1d(row, width, mode="wrap") for row, width in spread], axis=0)
    peak = (smooth >= np.roll(smooth, 1)) & (smooth > np.roll(smooth, -1)) & (smooth > outstanding * smooth.mean())
    return np.asarray((np.flatnonzero(peak) + 0.5) * SQUARE / BINS)


def alignment(
    placed: Samples, pieces: tuple[Floats, Floats], turns: Floats, settings: DirectionSettings
) -> tuple[Floats, Floats, Shared]:
    """Stiffness and torque (v,) on the headings of the views, and how directions couple them.

    pieces: as of `angle_errors`; turns: (v,) variance of the views' headings, radians². Whatever stands farther off its
    direction than both together explain runs in another one, and hardly counts.
    """
    (own, length), views = pieces, len(turns)
    errors = np.sqrt(own**2 + turns[placed.view])
    directions = wall_directions(placed.normals, placed.weight, errors, settings.outstanding)
    angle = np.arctan2(placed.normals[:, 1], placed.normals[:, 0])
    off = np.stack([(angle - turn + 0.5 * SQUARE) % SQUARE - 0.5 * SQUARE for turn in directions] or [angle])
    nearest = np.argmin(np.abs(off), axis=0)
    residual = off[nearest, np.arange(len(angle))]
    trust = (
        placed.weight / (settings.askew**2 + length * own**2) / (1 + (residual / (settings.apart * errors)) ** 2) ** 2
    )
    code = nearest * views + placed.view
    pull, load = (_by_view(code, trust * times, (len(directions), views)) for times in (1.0, residual))
    total = np.maximum(pull.sum(axis=1), 1e-12)
    torque = load.sum(axis=0) - (load.sum(axis=1) / total) @ pull
    return pull.sum(axis=0), torque, _coupling(pull, total)


def _by_view(code: NDArray[np.int64], values: Floats, shape: tuple[int, int]) -> Floats:
    """Sums (d, v) of values (n,) by direction and view."""
    sums = np.bincount(code, values, max(shape[0], 1) * shape[1]).astype(np.float64)
    return sums.reshape(-1, shape[1])[: shape[0]]


def _coupling(pull: Floats, total: Floats) -> Shared:
    """Directions as lines that views share: they turn with the headings, weighted by the pull (d, v) on each."""
    direction, view = np.nonzero(pull)
    arm = np.zeros((len(view), 3, 2))
    arm[:, 2, 0] = pull[direction, view]
    yielding = np.zeros((len(total), 2, 2))
    yielding[:, 0, 0] = 1 / total
    return Shared(view, arm, np.searchsorted(direction, np.arange(1, len(total) + 1)), yielding)
