"""The sonar side of the front end in simulated rooms: where single views fall short, what the beam tells of itself.

The rooms are those of the front end's table. What is missing there lies beyond doors too narrow for the beam and
farther than the infrared feels, so the same views are also judged where a sensor of theirs can reach.
"""

from typing import Any

import numpy as np
from shapely import Point, box

from frontend.contour import EdgeKind
from frontend.fusion import FusionSettings, fuse
from frontend.half_beam import HalfBeamSettings, beam_arcs, with_estimated_beam
from frontend.opening import undo_beam
from frontend.scan import Floats
from tests.benchmarks.door_rooms import (
    INFRARED,
    READINGS,
    DoorRoom,
    door_rooms,
    judge_doors,
    overlap,
    polar_polygon,
    through_doors,
    view_of,
)
from tests.frontend.rooms import FURNISHED, first_echoes, traced, true_ranges, turn
from tests.frontend.test_contour import between_walls

ROOMS, FRESH, RECORDING = 50, range(1000, 1100), 5
Row = dict[str, Any]


def rows() -> list[Row]:
    """All rows of the sonar side."""
    found = [fake_edge_row("precision"), fake_edge_row("recall")]
    for degrees in (5, 10, 20):
        found += [beam_row(degrees), noise_row(degrees)]
    for degrees in (10, 20):
        found += [*reach_rows(degrees), *fresh_rows(degrees)]
    return found


def reach_rows(degrees: float) -> list[Row]:
    """IoU of single views where echoes and infrared reach, and the most that any reading of them could give."""
    rooms = door_rooms(ROOMS, np.radians(degrees))
    views = [(view_of(room), polar_polygon(room.truth)) for room in rooms]
    horizon = Point(0, 0).buffer(INFRARED)
    near = [overlap(ours & horizon, true & horizon) for ours, true in views]
    inside = [overlap(*(_without_doors(room, ranges) for ranges in _both(room))) for room in rooms]
    whole = np.mean([overlap(*view) for view in views])
    most = np.mean([overlap(polar_polygon(told(room)), true) for room, (_, true) in zip(rooms, views, strict=True)])
    note = f"{ROOMS} rooms, effective half-beam {degrees}°"
    peers = {"IoU": float(whole), "all that the readings tell, every corner known": float(most)}
    return [
        row(f"single-view IoU within 10 ft at {degrees}°", float(np.mean(near)), None, {}, note),
        row(f"single-view IoU beside the doors at {degrees}°", float(np.mean(inside)), None, {}, note),
        row(f"share of the IoU that can be had at {degrees}°", float(whole / most), 0.95, peers, note),
    ]


def _both(room: DoorRoom) -> tuple[Floats, Floats]:
    return fuse(room.scan, FusionSettings()).ranges, room.truth


def _without_doors(room: DoorRoom, ranges: Floats) -> Any:
    return polar_polygon(np.where(through_doors(room), 0.0, ranges))


def told(room: DoorRoom) -> Floats:
    """Ranges (n,) that noiseless readings vouch for through doors, and the truth beside them."""
    beam = np.array([[np.inf, room.scan.sensor.half_beam]])
    echoes = first_echoes(room.truth, room.scan.sensor.half_beam)
    opened = undo_beam(room.scan.bearings, echoes, beam, 0.0, full_turn=True)
    return np.where(through_doors(room), np.maximum(opened, np.minimum(room.truth, INFRARED)), room.truth)


def fresh_rows(degrees: float) -> list[Row]:
    """Doors in rooms that nothing was looked at in."""
    rooms = door_rooms(FRESH.stop, np.radians(degrees), FRESH.start)
    visible, hit, opened, false = np.sum([judge_doors(room) for room in rooms], axis=0)
    note = f"{len(rooms)} other rooms"
    return [
        row(f"door edges found at {degrees}°, other rooms", hit / visible, 0.95, {}, note),
        row(f"false doors at {degrees}°, other rooms", false / opened, 0.05, {}, note, "lower"),
    ]


def beam_row(degrees: float) -> Row:
    """The half-beam that recordings of a few rooms tell, beside what was heard: whole readings of 1.4°."""
    rooms, settings = door_rooms(ROOMS, np.radians(degrees)), HalfBeamSettings()
    step = 360 / READINGS
    heard = np.floor(degrees / step) * step
    estimates = []
    for first in range(0, ROOMS, RECORDING):
        scans = [room.scan for room in rooms[first : first + RECORDING]]
        sensor = with_estimated_beam(scans[0].sensor, beam_arcs(scans, settings), settings)
        if sensor is not None:
            estimates.append(np.degrees(max(angle for _, angle in sensor.half_beams)) - heard)
    peers = {"least": float(np.min(estimates)), "mean": float(np.mean(estimates)), "told": len(estimates)}
    note = f"largest over recordings of {RECORDING} scans; under 0 is cautious; {ROOMS // RECORDING} recordings"
    return row(
        f"estimated half-beam of {degrees}° too wide by", float(np.max(estimates)), 0.5, peers, note, "lower", "°"
    )


def noise_row(degrees: float) -> Row:
    """How far the opened profile leans out of a flat wall around its foot, with and without what undoes it."""
    bearings, beam = turn(READINGS), np.radians(degrees)
    truth, _ = true_ranges(box(-9, -9, 2, 9), np.zeros(3), bearings)
    echoes, at_foot = first_echoes(truth, beam), np.abs(bearings) < 0.5 * beam
    leans = {}
    for name, noise in (("ours", 0.01), ("maximum alone", 0.0)):
        opened = [
            undo_beam(bearings, echoes + np.random.default_rng(seed).normal(0.0, 0.01, READINGS),
                      np.array([[np.inf, beam]]), noise, full_turn=True)
            for seed in range(40)
        ]  # fmt: skip
        leans[name] = float(np.mean((np.array(opened) - truth)[:, at_foot]))
    ours = abs(leans.pop("ours"))
    return row(f"lean of a flat wall at {degrees}°", 1000 * ours, 5.0, {k: 1000 * v for k, v in leans.items()},
               "noise 10 mm, a wall 2 m away, 40 scans", "lower", "mm")  # fmt: skip


def fake_edge_row(which: str) -> Row:
    """The flag of fake edges against what a thin beam can see, in a furnished room from 60 places."""
    hits = misses = false = 0
    for pose in np.random.default_rng(11).uniform([0.3, 0.3, -3], [7.7, 2.0, 3], (60, 3)):
        fake, same_wall = between_walls(FURNISHED, pose, 360)
        contour = traced(FURNISHED, pose, 360)
        called = contour.edge_kinds[contour.vertices] == EdgeKind.OCCLUSION
        hits += int(np.sum(called & fake))
        misses += int(np.sum(~called & fake))
        false += int(np.sum(called & same_wall))
    value = hits / (hits + (false if which == "precision" else misses))
    return row(f"fake edges flagged: {which}", value, 0.8 if which == "precision" else 0.95, {}, "360 beams, 60 places")


def row(
    name: str, value: float, target: float | None, peers: dict[str, float], note: str,
    better: str = "higher", unit: str = "",
) -> Row:  # fmt: skip
    """One row of the table."""
    return {
        "part": "sonar", "name": name, "value": float(value), "unit": unit, "better": better, "target": target,
        "peers": peers, "runs": 1, "note": note,
    }  # fmt: skip
