"""Visibility: what a scan confirms of a map, what it saw through, and what it cannot say."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import box

from frontend.fusion import FusedScan, FusionSettings, ReadingKind, fuse
from frontend.local_map import Faces
from frontend.rigid_motion import compose
from frontend.scan import Floats, Scan
from frontend.sensors.lidar import LIDAR
from frontend.visibility import VisibilitySettings, look
from tests.simulated_drives import faces_from, furnished_room, fused_at, world_of

SETTINGS = VisibilitySettings()


def ring_scan(ranges: Floats, mount: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> FusedScan:
    bearings = np.radians(np.arange(-180.0, 180.0))
    return fuse(Scan(bearings, ranges, replace(LIDAR, mount=mount), np.zeros(3), 0.0), FusionSettings())


def circle(radius: float, degrees: Floats) -> Faces:
    """Faces on a circle about the origin that look inwards."""
    out = np.column_stack([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    return Faces(radius * out, -out)


EVERYWHERE = np.arange(-179.5, 180.0, 5.0)


def test_a_scan_confirms_the_map_it_was_taken_in() -> None:
    rng = np.random.default_rng(1)
    world, pose = furnished_room(rng), np.array([2.5, 2.5, 0.4])
    seen = look(fused_at(world, pose, rng), pose, faces_from(world, [pose], rng), SETTINGS)
    assert seen.confirmed > 0.99
    assert seen.through == 0
    assert seen.visible > 200


def test_walls_that_stand_in_seen_free_space_are_counted_as_seen_through() -> None:
    """A partition that is on the map but not in the room: all its visible faces were looked through, no other is."""
    rng = np.random.default_rng(2)
    pose = np.array([3.0, 1.0, 0.0])
    empty, parted = world_of(box(0, 0, 6, 5)), world_of(box(0, 0, 6, 5), box(1.5, 3, 4.5, 3.2))
    faces = faces_from(parted, [pose], rng)
    on_partition = (np.abs(faces.points[:, 1] - 3.0) < 0.1) & (np.abs(faces.points[:, 0] - 3) < 1.6)
    seen = look(fused_at(empty, pose, rng), pose, faces, SETTINGS)
    share = np.count_nonzero(on_partition) / len(faces.points)
    assert share > 0.1
    assert seen.through == pytest.approx(share, abs=0.03)
    assert seen.confirmed == pytest.approx(1 - share, abs=0.03)


def test_what_a_nearer_obstacle_hides_is_neither_confirmed_nor_seen_through() -> None:
    seen = look(ring_scan(np.full(360, 2.0)), np.zeros(3), circle(4.0, EVERYWHERE), SETTINGS)
    assert (seen.visible, seen.confirmed, seen.through) == (0, 0, 0)


@pytest.mark.parametrize(("measured", "confirmed", "through"), [(3.0, 1, 0), (3.15, 1, 0), (5.0, 0, 1)])
def test_a_face_is_confirmed_within_the_tolerance_and_seen_through_beyond_it(
    measured: float, confirmed: int, through: int
) -> None:
    seen = look(ring_scan(np.full(360, measured)), np.zeros(3), circle(3.0, EVERYWHERE), SETTINGS)
    assert (seen.visible, seen.confirmed, seen.through) == (len(EVERYWHERE), confirmed, through)


def test_between_confirmed_and_seen_through_lies_a_band_that_says_neither() -> None:
    tolerance = SETTINGS.tolerance + 3 * SETTINGS.per_metre
    seen = look(
        ring_scan(np.full(360, 3 + tolerance + SETTINGS.through / 2)), np.zeros(3), circle(3, EVERYWHERE), SETTINGS
    )
    assert (seen.confirmed, seen.through) == (0, 0)
    assert seen.visible == len(EVERYWHERE)


def test_only_faces_that_turn_to_the_sensor_are_visible() -> None:
    faces = circle(3.0, EVERYWHERE)
    seen = look(ring_scan(np.full(360, 3.0)), np.zeros(3), Faces(faces.points, -faces.normals), SETTINGS)
    assert seen.visible == 0


def test_unusable_readings_say_nothing_of_the_faces_behind_them() -> None:
    ranges = np.full(360, 3.0)
    ranges[:180] = np.nan
    fused = ring_scan(ranges)
    assert np.count_nonzero(fused.kinds == ReadingKind.REJECTED) == 180
    seen = look(fused, np.zeros(3), circle(3.0, EVERYWHERE), SETTINGS)
    assert abs(seen.visible - len(EVERYWHERE) / 2) <= 2
    assert seen.confirmed == 1


def test_a_scan_of_half_a_turn_sees_nothing_behind_it() -> None:
    bearings = np.radians(np.arange(-90.0, 90.0))
    scan = Scan(bearings, np.full(180, 3.0), LIDAR, np.zeros(3), 0.0)
    seen = look(fuse(scan, FusionSettings()), np.array([0, 0, np.pi]), circle(3.0, EVERYWHERE), SETTINGS)
    behind = np.count_nonzero(np.abs(EVERYWHERE) > 90)
    assert abs(seen.visible - behind) <= 2
    assert seen.confirmed == 1


def test_the_pose_is_that_of_the_robot_and_the_sensor_sits_at_its_mount() -> None:
    mount, pose = (0.5, -0.2, 0.3), np.array([1.0, 2.0, -2.5])
    faces = circle(3.0, EVERYWHERE).moved(compose(pose, np.array(mount)))
    seen = look(ring_scan(np.full(360, 3.0), mount), pose, faces, SETTINGS)
    assert (seen.visible, seen.confirmed) == (len(EVERYWHERE), 1)
