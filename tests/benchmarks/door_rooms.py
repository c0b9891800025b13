"""Random rooms with doors, seen once by sonar and infrared from inside: what is there, and what was read."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon, box
from shapely.geometry.base import BaseGeometry

from frontend.contour import ContourSettings, trace
from frontend.fusion import FusionSettings, fuse
from frontend.scan import Floats, Scan, Sensor
from tests.frontend.rooms import first_echoes, true_ranges, turn

FEET, READINGS, WALL, YARD = 0.3048, 256, 0.12, 4.0
INFRARED = 10 * FEET


@dataclass(frozen=True, eq=False)
class DoorRoom:
    """A scan, the true ranges (n,) it was made of, and where doors open as seen: bearings (d, 2) right and left.

    doors: those both of whose jambs the infrared can tell; gaps: all through which anything can be seen.
    """

    scan: Scan
    truth: Floats
    doors: Floats
    gaps: Floats


def door_rooms(stop: int, half_beam: float, start: int = 0) -> list[DoorRoom]:
    """The same rooms for every half-beam: 4–6.5 by 3–5 m, one to three doors of 0.7–1 m, perhaps a cupboard."""
    return [_door_room(np.random.default_rng(seed), half_beam) for seed in range(start, stop)]


def judge_doors(room: DoorRoom) -> tuple[int, int, int, int]:
    """Visible doors, those found with both edges within one bearing step, openings drawn, and those without a door."""
    fused = fuse(room.scan, FusionSettings())
    opened = np.array([[o.right.bearing, o.left.bearing] for o in fused.openings]).reshape(-1, 2)
    found = np.any(np.all(np.abs(_turned(opened[:, None] - room.doors[None])) <= 2 * np.pi / READINGS, axis=2), axis=0)
    # Two gaps overlap where each begins before the other ends.
    before = _turned(room.gaps[None, :, 1] - opened[:, None, 0]) > 0
    after = _turned(opened[:, None, 1] - room.gaps[None, :, 0]) > 0
    return len(room.doors), int(np.sum(found)), len(opened), int(np.sum(~np.any(before & after, axis=1)))


def _turned(angles: Floats) -> Floats:
    return np.asarray((angles + np.pi) % (2 * np.pi) - np.pi)


def free_space_overlap(room: DoorRoom) -> tuple[float, float, float]:
    """IoU of the fused view with what is visible, that of the raw readings, and the fused view's false free share."""
    visible = polar_polygon(np.minimum(room.truth, room.scan.sensor.max_range))
    raw = polar_polygon(np.minimum(room.scan.ranges, room.scan.sensor.max_range))
    ours = view_of(room)
    return overlap(ours, visible), overlap(raw, visible), ours.difference(visible).area / visible.area


def view_of(room: DoorRoom) -> Polygon:
    """The free space of the fused view."""
    return trace(fuse(room.scan, FusionSettings()), ContourSettings()).free_space


def through_doors(room: DoorRoom) -> NDArray[np.bool_]:
    """Which bearings (n,) look through a gap of the walls."""
    middles, widths = np.mean(room.gaps, axis=1), room.gaps[:, 1] - room.gaps[:, 0]
    off = np.abs(_turned(room.scan.bearings[:, None] - middles[None]))
    return np.asarray(np.any(off <= widths / 2, axis=1))


def _door_room(rng: np.random.Generator, half_beam: float) -> DoorRoom:
    width, depth = rng.uniform(4.0, 6.5), rng.uniform(3.0, 5.0)
    outer = box(-WALL, -WALL, width + WALL, depth + WALL)
    inside: BaseGeometry = box(0, 0, width, depth)
    jambs = [_door(rng, side, width, depth) for side in rng.permutation(4)[: rng.integers(1, 4)]]
    if rng.random() < 0.5:
        x, y = rng.uniform(0.5, width - 1.2), depth - 0.45
        inside = inside.difference(box(x, y, x + 0.8, depth + 0.01))
        jambs = [door for door in jambs if not _blocked(door, x, y, depth)]
    yard = outer.buffer(YARD, join_style="mitre").difference(outer)
    passages = [_passage(door, width, depth) for door in jambs]
    world = shapely.union_all([inside, yard, *passages])
    pose = np.array([*rng.uniform([1.0, 0.9], [width - 1.0, depth - 0.9]), rng.uniform(-np.pi, np.pi)])
    return _seen(world, pose, jambs, half_beam, rng)


def _door(rng: np.random.Generator, side: int, width: float, depth: float) -> Floats:
    """Inner jambs (2, 2) of a door on a side of the room, right and left as seen from inside."""
    length = width if side % 2 == 0 else depth
    wide = rng.uniform(0.7, 1.0)
    start = rng.uniform(0.3, length - 0.3 - wide)
    along = np.array([start, start + wide])
    if side in (0, 3):
        along = along[::-1]
    across = np.full(2, (0.0, width, depth, 0.0)[side])
    return np.column_stack([across, along] if side % 2 else [along, across])[:: -1 if side % 2 == 0 else 1]


def _blocked(door: Floats, x: float, y: float, depth: float) -> bool:
    return bool(np.all(door[:, 1] >= y) and np.max(door[:, 0]) > x - 0.2 and np.min(door[:, 0]) < x + 1.0)


def _passage(door: Floats, width: float, depth: float) -> Polygon:
    """The gap in the wall behind a door, overlapping the room and the yard by a hair."""
    hair = 1e-4
    (ax, ay), (bx, by) = np.min(door, axis=0), np.max(door, axis=0)
    if ax == bx:
        return box(-WALL - hair, ay, hair, by) if ax == 0 else box(width - hair, ay, width + WALL + hair, by)
    return box(ax, -WALL - hair, bx, hair) if ay == 0 else box(ax, depth - hair, bx, depth + WALL + hair)


def _seen(
    world: BaseGeometry, pose: Floats, doors: list[Floats], half_beam: float, rng: np.random.Generator
) -> DoorRoom:
    bearings = turn(READINGS)
    truth, _ = true_ranges(world, pose, bearings)
    sensor = Sensor("sonar_infrared", 35 * FEET, 0.9 * FEET, half_beam, 0.005, 0.12 * 0.0254, INFRARED)
    ranges = first_echoes(truth, half_beam) + rng.normal(0.0, sensor.range_noise, READINGS)
    ranges = np.round(ranges / sensor.quantum) * sensor.quantum
    infrared = np.where(truth < INFRARED, 31, 30).astype(np.int16)
    scan = Scan(bearings, ranges, sensor, np.zeros(3), 0.0, infrared)
    gaps = np.array([_gap_seen(pose, door) for door in doors]).reshape(-1, 2)
    clear = np.array([_is_clear(world, pose, door, gap) for door, gap in zip(doors, gaps, strict=True)], dtype=bool)
    return DoorRoom(scan, truth, gaps[clear], gaps[gaps[:, 1] > gaps[:, 0]])


def _gap_seen(pose: Floats, door: Floats) -> Floats:
    """Bearings (2,) of where a door's opening begins and ends as seen; the second is smaller where nothing passes.

    A thick wall narrows the opening: on each side the inner or the outer corner of the wall bounds it.
    """
    inner = door - pose[:2]
    outer = inner + WALL * _outwards(inner)
    centre = np.arctan2(*np.mean(inner, axis=0)[::-1])
    sides = [(np.arctan2(p[:, 1], p[:, 0]) - centre + np.pi) % (2 * np.pi) - np.pi for p in (inner, outer)]
    right, left = max(np.min(s) for s in sides), min(np.max(s) for s in sides)
    middle = (centre - pose[2] + np.pi) % (2 * np.pi) - np.pi
    return np.asarray(np.array([right, left]) + middle)


def _outwards(inner: Floats) -> Floats:
    """Unit vector (2,) out of the room through a door whose jambs (2, 2) are seen from the origin."""
    out = np.array([inner[0, 1] - inner[1, 1], inner[1, 0] - inner[0, 0]])
    return np.asarray(out * np.sign(out @ np.mean(inner, axis=0)) / np.linalg.norm(out))


def _is_clear(world: BaseGeometry, pose: Floats, door: Floats, gap: Floats) -> bool:
    """Whether both jambs are in the infrared's sight, nothing behind is, and the gap is four readings wide."""
    inner = door - pose[:2]
    corners = np.vstack([inner, inner + WALL * _outwards(inner)])
    if np.max(np.linalg.norm(corners, axis=1)) > 0.95 * INFRARED or gap[1] - gap[0] < 4 * 2 * np.pi / READINGS:
        return False
    beyond, _ = true_ranges(world, pose, np.linspace(gap[0] + 0.01, gap[1] - 0.01, 9))
    before, _ = true_ranges(world, pose, gap + np.array([-0.01, 0.01]))
    return bool(np.all(beyond > INFRARED) and np.all(before < INFRARED))


def polar_polygon(ranges: Floats) -> Polygon:
    """The star-shaped polygon of a full turn of ranges (n,)."""
    bearings = turn(READINGS)
    return Polygon(np.maximum(ranges, 0.01)[:, None] * np.column_stack([np.cos(bearings), np.sin(bearings)]))


def overlap(a: BaseGeometry, b: BaseGeometry) -> float:
    """Intersection over union."""
    return float(a.intersection(b).area / a.union(b).area)
