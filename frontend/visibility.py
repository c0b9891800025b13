"""Visibility: what of a map a scan should have seen from a pose, what it confirms, and what it saw through.

A wrong match puts walls into free space that was seen to be empty; counting both ways tells it from a right one.
"""

from dataclasses import dataclass

import numpy as np

from frontend.compiled import compiled
from frontend.fusion import FusedScan, ReadingKind
from frontend.local_map import Faces
from frontend.rigid_motion import compose
from frontend.scan import Booleans, Floats


@dataclass(frozen=True)
class VisibilitySettings:
    """When a face counts as confirmed or seen through; metres."""

    tolerance: float = 0.15  # larger confirms more
    per_metre: float = 0.02  # added for each metre of range; larger forgives pose errors far away
    through: float = 0.1  # more than the tolerance that a reading must go past a face; larger sees through less
    steepest: float = 0.25  # least cosine between beam and normal; larger ignores more grazing faces


@dataclass(frozen=True)
class Visibility:
    """Shares of the map's visible faces that the scan confirms and that it saw through, and how many were visible."""

    confirmed: float
    through: float
    visible: int


def look(fused: FusedScan, pose: Floats, faces: Faces, settings: VisibilitySettings) -> Visibility:
    """Compare faces (room's frame) with what the scan at `pose` (3,) measured."""
    limits = np.array([settings.tolerance, settings.per_metre, settings.through, settings.steepest])
    eye = compose(pose, np.array(fused.scan.sensor.mount))
    known = (fused.kinds == ReadingKind.MEASURED) | (fused.kinds == ReadingKind.NO_RETURN)
    visible, confirmed, through = _count(
        fused.bearings, fused.ranges, known, fused.scan.full_turn, eye, faces.points, faces.normals, limits
    )
    return Visibility(confirmed / max(visible, 1), through / max(visible, 1), visible)


@compiled
def _count(
    bearings: Floats, ranges: Floats, known: Booleans, full_turn: bool, eye: Floats,
    points: Floats, normals: Floats, limits: Floats,
) -> tuple[int, int, int]:  # fmt: skip
    n = len(bearings)
    visible, confirmed, through = 0, 0, 0
    for k in range(len(points)):
        dx, dy = points[k, 0] - eye[0], points[k, 1] - eye[1]
        distance = np.hypot(dx, dy)
        if -(dx * normals[k, 0] + dy * normals[k, 1]) < limits[3] * distance:
            continue
        bearing = bearings[0] + (np.arctan2(dy, dx) - eye[2] - bearings[0]) % (2 * np.pi)
        after = np.searchsorted(bearings, bearing)
        if not full_turn and (after < 1 or after >= n):
            continue
        nearest, farthest, closest = np.inf, 0.0, np.inf
        usable = True
        for i in range(after - 2, after + 2):
            if not full_turn and (i < 0 or i >= n):
                continue
            reading = ranges[i % n]
            usable = usable and known[i % n]
            nearest, farthest = min(nearest, reading), max(farthest, reading)
            closest = min(closest, abs(reading - distance))
        tolerance = limits[0] + limits[1] * distance
        if not usable or distance > farthest + tolerance:
            continue
        visible += 1
        if closest < tolerance:
            confirmed += 1
        elif distance < nearest - tolerance - limits[2]:
            through += 1
    return visible, confirmed, through
