"""The pipeline: scans in order become poses, and the placed views become one room map.

Each scan is fused, traced and sketched (front end), placed and tied into the factor graph (back end); at the end
the views are merged where the graph finally puts them.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from backend.estimate import Estimate
from backend.polygon_merging import Merger
from backend.room_map import RoomMap
from frontend.door_edges import DoorEdges
from frontend.scan import Floats, Scan
from slam.checkpoint import Keeper
from slam.door_tracking import sharpened_views
from slam.mapper import Mapper
from slam.perception import Percept
from slam.settings import Settings


@dataclass(frozen=True, eq=False)
class Merged:
    """Every intermediate result of a run: the percepts of the scans that stand in the map, the estimate of all scans,
    the door edges tracked over them, the map, whose views are numbered like the percepts, and seconds per stage."""

    percepts: tuple[Percept, ...]
    estimate: Estimate
    door_edges: DoorEdges
    room: RoomMap
    timings: dict[str, float]

    @property
    def poses(self) -> Floats:
        """(m, 3) where the percepts were seen."""
        return self.estimate.poses[self.estimate.mapped]


def merge_scans(
    scans: Iterable[Scan], settings: Settings, keeper: Keeper | None = None, starts: Sequence[int] = ()
) -> Merged:
    """The room map of scans in their order; any iterable will do, a log as well as a live stream.

    keeper: writes checkpoints, and knows what was answered if the run goes on from one. starts: the numbers of scans
    that begin another drive, taken nobody knows where.
    """
    mapper = Mapper(settings.frontend, settings.poses, keeper.logbook if keeper else None)
    for number, scan in enumerate(scans):
        if number in starts:
            mapper.begin_session("another drive")
        mapper.add(scan)
        if keeper is not None:
            keeper.passed(scan, number in starts)
    return merged_so_far(mapper, settings)


def merged_so_far(mapper: Mapper, settings: Settings, merger: Merger | None = None) -> Merged:
    """What the scans that the mapper took in so far give; it may take in more afterwards.

    merger: holds the map of an earlier look, so that this one costs what has changed since.
    """
    estimate = mapper.result()
    clock = perf_counter()
    mapped = tuple(mapper.percepts[number] for number in np.flatnonzero(estimate.mapped))
    poses, covariances = estimate.poses[estimate.mapped], estimate.covariances[estimate.mapped]
    views, door_edges = sharpened_views(mapped, poses, covariances, settings.door_edges)
    merger = merger or Merger(settings.merging)
    merger.follow(views, poses)
    room = merger.result()
    return Merged(mapped, estimate, door_edges, room, {**mapper.timings, "merging": perf_counter() - clock})
