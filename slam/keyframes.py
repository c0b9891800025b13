"""Keyframes: the scans that carry the graph, session by session in the order they came."""

from collections.abc import Sequence

from frontend.local_map import Faces
from frontend.scan import Floats
from slam.perception import Percept


class Keyframe:
    """A scan that carries the graph: its place among the scans, its session, and its faces as now believed."""

    def __init__(self, scan: int, session: int, percept: Percept, pose: Floats) -> None:
        self.scan, self.session, self.percept, self.pose = scan, session, percept, pose
        self._placed: tuple[Floats, Faces] | None = None

    @property
    def faces(self) -> Faces:
        """Placed only when somebody looks: a mended graph moves every keyframe, but few are looked at again."""
        if self._placed is None or self._placed[0] is not self.pose:
            self._placed = (self.pose, Faces.placed(self.percept.surface, self.pose))
        return self._placed[1]


def around(keyframes: Sequence[Keyframe], number: int, before: int, after: int = 0) -> list[Keyframe]:
    """The keyframe of this number with its neighbours of the same session: others may stand in another frame."""
    near = keyframes[max(0, number - before) : number + after + 1]
    return [keyframe for keyframe in near if keyframe.session == keyframes[number].session]
