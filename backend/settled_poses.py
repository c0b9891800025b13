"""Settled poses: where views settled, kept from one look at the map to the next.

What was added or moved since the last look settles among the views that stand, at the cost of what it sees. Those give
way in turn once so much has changed that all settle anew; a view among many moves them by about a millimetre.
"""

import numpy as np
from numpy.typing import NDArray

from backend.samples import Samples
from backend.settling import SettleSettings, settle, settle_among

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class SettledPoses:
    """Poses given and settled, by the index of the view."""

    def __init__(self, settings: SettleSettings) -> None:
        self._settings = settings
        self._known: dict[int, tuple[Floats, Floats]] = {}
        self._changed: set[int] = set()

    def forget(self, index: int) -> None:
        """The view `index` is gone, or will be another."""
        if self._known.pop(index, None) is not None:
            self._changed.add(index)

    def settled(self, local: Samples, index: Ints, given: Floats) -> Floats:
        """Poses (v, 3) of the views `index` (v,) put at `given` (v, 3); samples as for `settle`."""
        moving = np.array([self._moved(i, pose) for i, pose in zip(index.tolist(), given, strict=True)], dtype=np.bool_)
        self._changed.update(index[moving].tolist())
        if len(self._changed) > self._settings.stale * len(index):
            self._changed, poses = set(), settle(local, given, self._settings)
        elif moving.any():
            stood = np.array([self._known[i][1] if i in self._known else np.zeros(3) for i in index.tolist()])
            poses = settle_among(local, given, stood, moving, self._settings)
        else:
            poses = np.array([self._known[i][1] for i in index.tolist()])
        self._known = {i: (at, pose) for i, at, pose in zip(index.tolist(), given, poses, strict=True)}
        return poses

    def _moved(self, index: int, pose: Floats) -> bool:
        known = self._known.get(index)
        return known is None or not np.array_equal(known[0], pose)
