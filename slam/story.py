"""The story of a run: what figures and viewers read once it is over."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from backend.next_view import NextView, NextViewSettings, next_view
from backend.room_map import RoomMap
from frontend.scan import Floats
from slam.perception import Percept


@dataclass(frozen=True, eq=False)
class Story:
    """Percepts of n scans, their poses (n, 3), the map, landmarks (l, 2), and paths (p, 3) by planner's name."""

    percepts: Sequence[Percept]
    poses: Floats
    room: RoomMap
    landmarks: Floats
    paths: dict[str, Floats]

    @cached_property
    def next_view(self) -> NextView | None:
        """Where to look next, coming from the last pose; None where nothing is left to see."""
        return next_view(self.room, self.poses[-1], self.percepts[0].scan.sensor.max_range, NextViewSettings())
