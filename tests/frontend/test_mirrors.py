"""Claims about mirrors: smooth walls, heard from their foot alone."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import box

from frontend.fusion import FusionSettings, ReadingKind, fuse
from frontend.mirrors import MirrorSettings, beside_mirrors, mirrors
from frontend.scan import Scan
from slam.simulation.floors import feature, plan_of
from slam.simulation.record import Recipe, drive_through
from slam.simulation.world import build_world

ROOM = box(0, 0, 2.4, 6)


def scan_in(material: str, x: float = 1.1, y: float = 2.0) -> Scan:
    """A scan in a narrow room whose walls are all of one material, heading along x."""
    shell = ROOM.buffer(0.2, join_style="mitre").difference(ROOM)
    world = build_world(plan_of("room", "", [feature(shell, "wall", material=material)]))
    return drive_through(world, np.array([[x, y, 0.0]]), Recipe(seed=3))[0]


@pytest.mark.parametrize(("x", "y"), [(1.1, 2.0), (1.3, 3.0), (1.0, 4.0)])
def test_the_near_walls_of_a_smooth_room_are_found_with_their_feet(x: float, y: float) -> None:
    found = mirrors(scan_in("smooth", x, y), MirrorSettings())
    assert min(mirror.metres for mirror in found) == pytest.approx(min(x, 2.4 - x), abs=0.03)
    for mirror in found:
        assert abs(np.sin(mirror.foot)) < np.sin(np.radians(4))
        assert mirror.metres == pytest.approx(2.4 - x if np.cos(mirror.foot) > 0 else x, abs=0.03)


@pytest.mark.parametrize(("x", "y"), [(1.1, 2.0), (1.3, 3.0), (1.0, 4.0), (0.5, 0.6)])
def test_a_rough_room_has_no_mirrors(x: float, y: float) -> None:
    assert mirrors(scan_in("rough", x, y), MirrorSettings()) == []


def test_past_a_mirror_nothing_is_free_beyond_its_line() -> None:
    scan = scan_in("smooth")
    fused = fuse(scan, FusionSettings())
    x = 1.1 + fused.ranges * np.cos(fused.bearings)
    assert x.min() > -0.1
    assert x.max() < 2.5


def test_a_mirror_is_a_wall_about_its_foot_and_no_surface_elsewhere() -> None:
    scan = scan_in("smooth")
    beside, fused = beside_mirrors(scan, MirrorSettings()), fuse(scan, FusionSettings())
    assert np.all(fused.kinds[beside.wall] == ReadingKind.MEASURED)
    assert np.all(fused.kinds[beside.bound] != ReadingKind.MEASURED)
    wall = beside.wall & (np.abs(scan.bearings) < 1)
    np.testing.assert_allclose(fused.ranges[wall] * np.cos(scan.bearings[wall]), 1.3, atol=0.04)


def test_a_lone_near_reading_is_no_mirror() -> None:
    scan = scan_in("rough")
    ranges = scan.ranges.copy()
    ranges[40] = 0.4
    assert mirrors(replace(scan, ranges=ranges), MirrorSettings()) == []
