"""Wall directions: buildings run in few directions and those at right angles to them, and views turn along with these.

A view that shares little surface with the others has only its pose's word for its heading, and a wall five metres off
moves by a decimetre with one degree. Directions are sought in all views at once, and none where surfaces face
everywhere alike; which way they point is eliminated like the lines that views share, so all views turn freely together.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from backend.samples import Samples
from backend.shared_lines import Shared

Floats = NDArray[np.float64]
SQUARE = 0.5 * np.pi
BINS = 360  # of a quarter turn
SPREAD = 3.0  # bins; the width of a direction
OUTSTANDING = 8.0  # times an even spread of surface over all directions, from which on one is a direction


def wall_directions(normals: Floats, weight: Floats) -> Floats:
    """Directions (d,) in 0…π/2 in which, or square to which, outstandingly much of the surface faces."""
    place = (np.arctan2(normals[:, 1], normals[:, 0]) % SQUARE) / SQUARE * BINS
    faced = np.bincount(place.astype(np.int64) % BINS, weight, BINS)
    smooth = ndimage.gaussian_filter1d(faced, SPREAD, mode="wrap")
    peak = (smooth >= np.roll(smooth, 1)) & (smooth > np.roll(smooth, -1)) & (smooth > OUTSTANDING * faced.mean())
    return np.asarray((np.flatnonzero(peak) + 0.5) * SQUARE / BINS)


def alignment(placed: Samples, views: int, askew: float) -> tuple[Floats, Floats, Shared]:
    """Stiffness and torque (v,) on the headings of the views, and how directions couple them.

    askew: radians a metre of surface may stand off its direction; samples farther off count less.
    """
    directions = wall_directions(placed.normals, placed.weight)
    angle = np.arctan2(placed.normals[:, 1], placed.normals[:, 0])
    off = np.stack([(angle - turn + 0.5 * SQUARE) % SQUARE - 0.5 * SQUARE for turn in directions] or [angle])
    nearest = np.argmin(np.abs(off), axis=0)
    residual = off[nearest, np.arange(len(angle))]
    trust = placed.weight / (1 + (residual / askew) ** 2) / askew**2
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
