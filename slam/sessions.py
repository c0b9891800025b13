"""Sessions: drives without a common start, each in a frame of its own until a place of one is recognised in another.

Every session starts on an island of its own, too far from the others for anything to be taken for its neighbour.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from frontend.rigid_motion import between, compose, inverse
from frontend.scan import Floats
from slam.keyframes import Keyframe

ISLAND = 1000.0  # metres between the starts of two sessions: farther than any building reaches
AGREE_METRES, AGREE_RADIANS = 0.5, 0.1  # that two recognitions may differ, as the session drifts between them
APART_METRES, APART_RADIANS = 0.5, 0.5  # between two views that count as two


@dataclass(frozen=True, eq=False)
class Recognition:
    """Keyframe `moving` was recognised at `pose` (3,) in the frame of keyframe `fixed`, of another session.

    covariance: (3, 3) in the moving one's axes.
    """

    fixed: int
    moving: int
    pose: Floats
    covariance: Floats

    def carry(self, keyframes: Sequence[Keyframe]) -> Floats:
        """The pose (3,) of the moving session's frame in the fixed one's, by all that is now believed of both."""
        return compose(compose(keyframes[self.fixed].pose, self.pose), inverse(keyframes[self.moving].pose))


def agreeing(
    found: Recognition, doubted: Sequence[Recognition], keyframes: Sequence[Keyframe], within: tuple[float, float]
) -> Recognition | None:
    """The first of the doubted ones, between the same two frames, that says the same within metres and radians."""
    here = keyframes[found.moving].pose
    claim = compose(found.carry(keyframes), here)
    for earlier in doubted:
        off = between(claim, compose(earlier.carry(keyframes), here))
        if np.hypot(*off[:2]) < within[0] and abs(off[2]) < within[1]:
            return earlier
    return None


class Sessions:
    """Which sessions there are, and which share a frame: that of the earliest of them."""

    def __init__(self) -> None:
        self._roots: list[int] = []
        self._doubted: list[Recognition] = []

    def begin(self) -> Floats:
        """A new session; the pose (3,) of its first scan."""
        self._roots.append(len(self._roots))
        return self.start(self._roots[-1])

    @property
    def newest(self) -> int:
        """The number of the session that goes on."""
        return len(self._roots) - 1

    @property
    def apart(self) -> bool:
        """Whether some have not been joined."""
        return any(root != 0 for root in self._roots)

    def root(self, session: int) -> int:
        """The earliest session with the same frame."""
        return self._roots[session]

    def start(self, root: int) -> Floats:
        """The pose (3,) of the first scan of a session that kept its frame."""
        return np.array([ISLAND * root, 0.0, 0.0])

    def told(self, pose: Floats, session: int) -> Floats:
        """A pose (3,) in the frame of its root's first scan."""
        return np.asarray(pose - self.start(self._roots[session]))

    def others(self, session: int) -> list[int]:
        """The roots of sessions with other frames than this one."""
        return sorted(set(self._roots) - {self._roots[session]})

    def confirm(self, found: Recognition, keyframes: Sequence[Keyframe]) -> Recognition | None:
        """An earlier recognition that says the same from another place: two are believed, one is only remembered."""
        others = [one for one in self._doubted if self._another_view(one, found, keyframes)]
        earlier = agreeing(found, others, keyframes, (AGREE_METRES, AGREE_RADIANS))
        if earlier is not None:
            return earlier
        self._doubted.append(found)
        return None

    def join(self, found: Recognition, keyframes: Sequence[Keyframe]) -> tuple[list[int], Floats]:
        """Two frames become the earlier one: the keyframes of the later, and the pose (3,) of its frame there."""
        fixed, moving = self._frames(found, keyframes)
        kept, gone = min(fixed, moving), max(fixed, moving)
        carry = found.carry(keyframes) if gone == moving else inverse(found.carry(keyframes))
        moved = [k for k, keyframe in enumerate(keyframes) if self._roots[keyframe.session] == gone]
        self._roots = [kept if root == gone else root for root in self._roots]
        return moved, carry

    def _another_view(self, earlier: Recognition, found: Recognition, keyframes: Sequence[Keyframe]) -> bool:
        """Whether they are of the same two frames, and from places or in directions that count as two."""
        moved = between(keyframes[earlier.moving].pose, keyframes[found.moving].pose)
        stood = np.hypot(*moved[:2]) < APART_METRES and abs(moved[2]) < APART_RADIANS
        return not stood and self._frames(earlier, keyframes) == self._frames(found, keyframes)

    def _frames(self, found: Recognition, keyframes: Sequence[Keyframe]) -> tuple[int, int]:
        return self._roots[keyframes[found.fixed].session], self._roots[keyframes[found.moving].session]
