"""The fused scan: sonar and infrared combined by the three rules, with the beam undone (Flynn 1988, §3.3).

A scan without infrared, and without a beam to undo, keeps its ranges.
"""

from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from frontend.infrared_edges import InfraredEdge, Opening, infrared_edges, pair_edges
from frontend.mirrors import MirrorSettings, beside_mirrors
from frontend.opening import smeared, undo_beam
from frontend.redrawing import gap_core, opening_arc, why_closed
from frontend.rigid_motion import transform
from frontend.room_corners import room_corners
from frontend.scan import Booleans, Floats, Integers, Scan
from frontend.wall_lines import Profile


class ReadingKind(IntEnum):
    """What became of a reading."""

    MEASURED = 0
    NO_RETURN = 1
    DOOR_ARC = 2
    REJECTED = 3
    INFERRED = 4  # in a corner too narrow for the beam: where its two walls would meet


@dataclass(frozen=True)
class FusionSettings:
    """Opinions of the fusion.

    beam_share: the share of the stated half-beam to undo.
    """

    beam_share: float = 1.0  # larger reaches deeper into corners and gaps, and past the truth where it exceeds 1
    beam_doubt: float = (
        1.0  # of what undoing the beam moved: bright walls are heard twice as far off; larger trusts less
    )
    no_return_clears: float = 2.0  # metres a reading without echo counts as free; larger opens rooms behind glass
    spike_height: float = 0.5  # metres; larger lets more lone readings (specular, crosstalk) pass as surface
    spike_readings: int = 2  # readings a lone run may have and still be rejected; larger rejects narrow true gaps
    door_depth: float = 0.15  # metres a jamb is nearer than the infrared's range; larger misses far doors
    mirrors: MirrorSettings = field(default_factory=MirrorSettings)


@dataclass(frozen=True, eq=False)
class FusedScan:
    """A scan after the rules.

    ranges: (n,) metres along each bearing (n,), always finite; raw_ranges: (n,) as the sensor gave them;
    vouched: (n,) as far as readings vouch for, without what is inferred.
    kinds: (n,) ReadingKind. spread: (n,) standard deviation along the beam, metres, and doubt: (n,) what undoing the
    beam adds to it.
    edges: valid infrared edges; openings: the pairs among them that were redrawn as arcs.
    jambs: (d, 2, 2) the right and left jamb of each opening in the robot's frame.
    reasons: why a reading was rejected or an edge opened nothing, by reading.
    """

    scan: Scan
    bearings: Floats
    ranges: Floats
    raw_ranges: Floats
    vouched: Floats
    kinds: NDArray[np.uint8]
    spread: Floats
    doubt: Floats
    edges: tuple[InfraredEdge, ...]
    openings: tuple[Opening, ...]
    jambs: Floats
    reasons: dict[int, str]

    @property
    def origin(self) -> Floats:
        """Where the sensor sits in the robot's frame, (2,)."""
        return np.array(self.scan.sensor.mount[:2])


def fuse(scan: Scan, settings: FusionSettings) -> FusedScan:
    """Judge each reading, undo the beam, then redraw what the infrared opens; a thin beam has nothing to undo."""
    kinds, reasons = _judge(scan, settings)
    if scan.sensor.half_beam <= 0 and scan.infrared is None:
        return _unchanged(scan, kinds, reasons, settings)
    measured = kinds == ReadingKind.MEASURED
    opened = undo_beam(
        scan.bearings,
        np.where(measured, scan.ranges, np.nan),
        scan.sensor.beam * np.array([1.0, settings.beam_share]),
        scan.sensor.range_noise,
        scan.full_turn,
    )
    ranges = _filled(opened, kinds, scan, settings)
    bounds = _smeared(ranges, kinds, scan)
    kinds[bounds] = ReadingKind.NO_RETURN
    reasons |= {int(i): f"the beam is too wide for this corner: it is at least {ranges[i]:.2f} m deep" for i in bounds}
    edges = infrared_edges(scan)
    pairs, lone = pair_edges(edges, scan)
    reasons |= {edge.jamb: f"a lone infrared edge at {np.degrees(edge.bearing):.1f}° opens nothing" for edge in lone}
    profile = Profile(scan.bearings, ranges, kinds == ReadingKind.MEASURED)
    closed = [why_closed(opening, profile, scan, settings.door_depth) for opening in pairs]
    reasons |= {pair.right.jamb: reason for pair, reason in zip(pairs, closed, strict=True) if reason is not None}
    openings = [pair for pair, reason in zip(pairs, closed, strict=True) if reason is None]
    for opening in openings:
        ranges, kinds = _redrawn(opening, ranges, kinds, scan)
    vouched = ranges
    ranges, kinds = _with_corners(ranges, kinds, scan)
    ranges, vouched, kinds = _up_to_mirrors(ranges, vouched, kinds, (scan, settings.mirrors))
    moved = np.where(kinds == ReadingKind.MEASURED, ranges - scan.ranges, 0.0)
    return FusedScan(
        scan, scan.bearings, ranges, scan.ranges, vouched, kinds, _spread(scan),
        settings.beam_doubt * np.nan_to_num(moved),
        tuple(edges), tuple(openings), _jambs(openings, ranges, scan), reasons,
    )  # fmt: skip


def _unchanged(scan: Scan, kinds: NDArray[np.uint8], reasons: dict[int, str], settings: FusionSettings) -> FusedScan:
    """A scan of thin beams without infrared: there is no beam to undo, nothing to redraw and nothing to infer."""
    measured = np.where(kinds == ReadingKind.MEASURED, scan.ranges, np.nan)
    ranges = _filled(measured, kinds, scan, settings)
    return FusedScan(
        scan, scan.bearings, ranges, scan.ranges, ranges, kinds, _spread(scan), np.zeros(ranges.size),
        (), (), np.empty((0, 2, 2)), reasons,
    )  # fmt: skip


def _spread(scan: Scan) -> Floats:
    """(n,) standard deviation along the beam: noise and rounding."""
    return np.full(scan.ranges.size, float(np.hypot(scan.sensor.range_noise, scan.sensor.quantum / np.sqrt(12))))


def _judge(scan: Scan, settings: FusionSettings) -> tuple[NDArray[np.uint8], dict[int, str]]:
    """The kind (n,) of each reading before fusion, and why readings are rejected. Rule 2: no echo is no surface."""
    sensor, ranges = scan.sensor, scan.ranges
    kinds = np.full(ranges.size, ReadingKind.MEASURED, dtype=np.uint8)
    kinds[ranges >= sensor.max_range] = ReadingKind.NO_RETURN
    unusable, near = np.isnan(ranges), ranges < sensor.min_range
    reasons = {int(i): "unusable reading" for i in np.flatnonzero(unusable)}
    reasons |= {
        int(i): f"{ranges[i]:.2f} m is under the sensor's least range {sensor.min_range:.2f} m"
        for i in np.flatnonzero(near)
    }
    kinds[unusable | near] = ReadingKind.REJECTED
    for i in np.flatnonzero(_spikes(scan, kinds == ReadingKind.MEASURED, settings)):
        kinds[i] = ReadingKind.REJECTED
        reasons[int(i)] = (
            f"{ranges[i]:.2f} m stands alone between nearer readings: a wide beam cannot see so thin a gap"
        )
    return kinds, reasons


def _spikes(scan: Scan, measured: Booleans, settings: FusionSettings) -> Booleans:
    """Lone far readings of a wide beam (n,): specular losses, which undoing the beam would spread over a window."""
    if scan.sensor.half_beam <= 0:
        return np.zeros(scan.ranges.size, dtype=bool)
    ranges = np.where(measured, scan.ranges, np.nan)
    reach = settings.spike_readings
    padded = np.pad(ranges, reach, mode="wrap") if scan.full_turn else np.pad(ranges, reach, constant_values=np.nan)
    before = np.stack([padded[k : k + ranges.size] for k in range(reach)])
    after = np.stack([padded[reach + 1 + k : reach + 1 + k + ranges.size] for k in range(reach)])
    nearest_before = np.min(np.where(np.isnan(before), np.inf, before), axis=0)
    nearest_after = np.min(np.where(np.isnan(after), np.inf, after), axis=0)
    beside = np.maximum(nearest_before, nearest_after)
    spikes = ranges > beside + settings.spike_height
    spikes[[i for i in np.flatnonzero(spikes) if _clear_to_infrared(int(i), float(beside[i]), scan)]] = False
    return np.asarray(spikes)


def _clear_to_infrared(reading: int, beside: float, scan: Scan) -> bool:
    """Whether the infrared feels nothing in the whole beam at the range beside a reading: a gap as wide as the beam."""
    if scan.infrared is None:
        return False
    width = int(scan.sensor.half_beam_at(beside) / np.median(np.diff(scan.bearings)))
    places = reading + np.arange(-width, width + 1)
    if not scan.full_turn and not (places[0] >= 0 and places[-1] < scan.bearings.size):
        return False
    return bool(np.all(scan.infrared[places % scan.bearings.size] % 10 == 0))


def _smeared(ranges: Floats, kinds: NDArray[np.uint8], scan: Scan) -> Integers:
    """Measured readings (s,) that only bound a corner or gap from below (rule 2: never a surface)."""
    if scan.sensor.half_beam <= 0 or scan.bearings.size < 3:
        return np.empty(0, np.int64)
    tolerance = 2 * float(np.hypot(scan.sensor.range_noise, scan.sensor.quantum))
    widest = int(np.ceil(scan.sensor.half_beam / np.median(np.diff(scan.bearings))))
    bounds = smeared(ranges, tolerance, max(widest, 2), scan.full_turn)
    return np.asarray(bounds[kinds[bounds] == ReadingKind.MEASURED])


def _filled(opened: Floats, kinds: NDArray[np.uint8], scan: Scan, settings: FusionSettings) -> Floats:
    """Ranges (n,) with a cautious one wherever nothing was measured: no farther than the nearer neighbour says."""
    measured = kinds == ReadingKind.MEASURED
    ranges = np.where(measured, opened, np.nan)
    silent = kinds == ReadingKind.NO_RETURN
    ranges[silent] = min(settings.no_return_clears, scan.sensor.max_range)
    rejected = np.flatnonzero(kinds == ReadingKind.REJECTED)
    known = np.flatnonzero(~np.isnan(ranges))
    if rejected.size and known.size:
        before, after = _known_neighbours(rejected, known, ranges, scan.full_turn)
        ranges[rejected] = np.minimum(before, after)
    floor = max(scan.sensor.min_range, 0.01)
    return np.maximum(np.where(np.isnan(ranges), floor, ranges), 0.01)


def _known_neighbours(places: Integers, known: Integers, ranges: Floats, full_turn: bool) -> tuple[Floats, Floats]:
    """Ranges of the nearest known readings before and after each place; nan past the ends of a part turn."""
    slot = np.searchsorted(known, places)
    before, after = ranges[known[slot - 1]], ranges[known[slot % known.size]]
    if not full_turn:
        before = np.where(slot == 0, np.nan, before)
        after = np.where(slot == known.size, np.nan, after)
    return before, after


def _redrawn(
    opening: Opening, ranges: Floats, kinds: NDArray[np.uint8], scan: Scan
) -> tuple[Floats, NDArray[np.uint8]]:
    """Ranges and kinds (n,) with the arc drawn; what the sonar measured through a wide gap beyond it stays measured."""
    arc, places = opening_arc(opening, ranges, scan), opening.readings
    drawn = (arc > ranges[places]) | ~gap_core(opening, scan)
    ranges, kinds = ranges.copy(), kinds.copy()
    ranges[places] = arc
    kinds[places[drawn]] = ReadingKind.DOOR_ARC
    return ranges, kinds


def _with_corners(ranges: Floats, kinds: NDArray[np.uint8], scan: Scan) -> tuple[Floats, NDArray[np.uint8]]:
    """Ranges and kinds (n,) with the corners that two walls beside them foretell."""
    profile = Profile(scan.bearings, ranges, kinds == ReadingKind.MEASURED)
    ranges, kinds = ranges.copy(), kinds.copy()
    for corner in room_corners(profile, np.isfinite(scan.ranges) & (kinds != ReadingKind.DOOR_ARC), scan):
        ranges[corner.readings], kinds[corner.readings] = corner.ranges, ReadingKind.INFERRED
    return ranges, kinds


def _up_to_mirrors(
    ranges: Floats, vouched: Floats, kinds: NDArray[np.uint8], read: tuple[Scan, MirrorSettings]
) -> tuple[Floats, Floats, NDArray[np.uint8]]:
    """Ranges, what is vouched for, and kinds (n,) where smooth walls answer about their feet and mirror all else."""
    beside, kinds = beside_mirrors(*read), kinds.copy()
    kinds[(beside.farthest < ranges) | beside.bound] = ReadingKind.NO_RETURN
    kinds[beside.wall] = ReadingKind.MEASURED
    ranges = np.where(beside.wall, beside.farthest, np.minimum(ranges, beside.farthest))
    return ranges, np.minimum(vouched, beside.farthest), kinds


def _jambs(openings: list[Opening], ranges: Floats, scan: Scan) -> Floats:
    """Jamb points (d, 2, 2) in the robot's frame: bearing from the infrared, range from the opened sonar."""
    edges = [edge for opening in openings for edge in (opening.right, opening.left)]
    bearings = np.array([edge.bearing for edge in edges])
    reach = np.array([ranges[edge.jamb] for edge in edges])
    points = reach[:, None] * np.column_stack([np.cos(bearings), np.sin(bearings)]) if edges else np.empty((0, 2))
    return transform(points, np.array(scan.sensor.mount)).reshape(-1, 2, 2)
