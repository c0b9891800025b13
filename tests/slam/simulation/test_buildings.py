import numpy as np
import pytest
import shapely
from shapely import LineString, Point

from slam.simulation.buildings import apartment, office
from slam.simulation.floors import Plan
from slam.simulation.trajectory import true_poses
from slam.simulation.world import build_world


@pytest.mark.parametrize(("plan", "rooms", "scans"), [(apartment(), 6, 44), (office(), 21, 147)])
def test_a_building_is_one_free_space_that_its_drive_goes_through_with_elbow_room(
    plan: Plan, rooms: int, scans: int
) -> None:
    world = build_world(plan)
    assert len(world.rooms) == rooms  # the office's corridor is the twenty-first
    assert all(world.free.intersects(room.centroid.buffer(1.5)) for room in world.rooms)
    assert world.drive is not None
    assert len(true_poses(world.drive)) == scans
    assert world.free.buffer(1e-6).contains(LineString(world.drive.waypoints).buffer(0.2))


def test_the_apartment_has_seven_doors_nine_things_and_one_room_of_mirrors() -> None:
    world = build_world(apartment())
    assert len(world.doors) == 7
    assert len([body for body in world.solids if body.kind == "obstacle"]) == 9
    middles = world.surfaces.segments.mean(axis=1)
    smooth = middles[world.surfaces.roughness < 1e-3]
    bathroom = next(room for room in world.rooms if room.contains(Point(7, 1)))
    assert shapely.distance(bathroom, shapely.points(smooth)).max() < 0.06


def test_the_office_is_driven_round_more_than_once() -> None:
    world = build_world(office())
    assert world.drive is not None
    angles = np.unwrap(np.arctan2(*(world.drive.waypoints - [17.8, 11.0]).T[::-1]))
    assert abs(angles[-1] - angles[0]) > 2 * np.pi
