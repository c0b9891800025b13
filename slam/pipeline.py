"""The pipeline: scans in order become poses, and the placed views become one room map.

Each scan is fused, traced and sketched (front end), placed and tied into the factor graph (back end); at the end
the views are merged where the graph finally puts them.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from time import perf_counter

from backend.estimate import Estimate
from backend.polygon_merging import merge_views
from backend.room_map import RoomMap
from frontend.scan import Scan
from slam.checkpoint import Keeper
from slam.mapper import Mapper
from slam.perception import Percept
from slam.settings import Settings


@dataclass(frozen=True, eq=False)
class Merged:
    """Every intermediate result of a run: one percept per scan, the estimate, the map, and seconds per stage."""

    percepts: tuple[Percept, ...]
    estimate: Estimate
    room: RoomMap
    timings: dict[str, float]


def merge_scans(scans: Iterable[Scan], settings: Settings, keeper: Keeper | None = None) -> Merged:
    """The room map of scans in their order; any iterable will do, a log as well as a live stream.

    keeper: writes checkpoints, and knows what was answered if the run goes on from one.
    """
    mapper = Mapper(settings.frontend, settings.poses, keeper.logbook if keeper else None)
    for scan in scans:
        mapper.add(scan)
        if keeper is not None:
            keeper.passed(scan)
    return merged_so_far(mapper, settings)


def merged_so_far(mapper: Mapper, settings: Settings) -> Merged:
    """What the scans that the mapper took in so far give; it may take in more afterwards."""
    estimate = mapper.result()
    clock = perf_counter()
    room = merge_views([percept.view for percept in mapper.percepts], estimate.poses, settings.merging)
    return Merged(tuple(mapper.percepts), estimate, room, {**mapper.timings, "merging": perf_counter() - clock})
