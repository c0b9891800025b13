import numpy as np
import pytest

from frontend.scan import Scan
from frontend.sensors.transducer import FOOT
from slam.simulation.plans import PLANS
from slam.simulation.record import Recipe, drive_through
from slam.simulation.trajectory import true_poses
from slam.simulation.world import World, build_world


def scene(name: str) -> tuple[World, list[Scan]]:
    world = build_world(PLANS[name]())
    assert world.drive is not None
    return world, drive_through(world, true_poses(world.drive), Recipe(seed=1))


def between(scan: Scan, first: float, last: float) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    degrees = np.degrees(scan.bearings)
    return (degrees > first) & (degrees < last)


def test_the_basement_is_19_by_13_feet_with_three_doors_and_three_things_in_it() -> None:
    world = build_world(PLANS["flynn_basement"]())
    left, bottom, right, top = world.rooms[0].bounds
    assert np.array([right - left, top - bottom]) / FOOT == pytest.approx([19, 13], abs=1e-3)
    assert all(30 <= np.linalg.norm(door.jambs[1] - door.jambs[0]) / FOOT * 12 <= 36.1 for door in world.doors)
    assert len(world.doors) == len([body for body in world.solids if body.kind == "obstacle"]) == 3


def test_in_the_basement_the_infrared_looks_through_every_door_from_some_pose() -> None:
    world, scans = scene("flynn_basement")
    assert world.drive is not None
    for door in world.doors:
        middle = door.jambs.mean(axis=0)
        through = []
        for scan, pose in zip(scans, true_poses(world.drive), strict=True):
            bearing = np.arctan2(*(middle - pose[:2])[::-1]) - pose[2]
            nearest = np.argmin(np.abs(np.angle(np.exp(1j * (scan.bearings - bearing)))))
            assert scan.infrared is not None
            through.append(scan.infrared[nearest] == 30 and scan.ranges[nearest] < 10 * FOOT)
        assert any(through), door.name


def test_the_closet_door_in_front_is_missing_from_the_sonar_and_felt_by_the_infrared_as_11() -> None:
    _, scans = scene("flynn_closet_door")
    ahead = between(scans[0], -20, 20)
    assert np.median(scans[0].ranges[ahead]) > 4 * 1.5 * FOOT
    assert scans[0].infrared is not None
    assert np.mean(scans[0].infrared[ahead] == 11) > 0.9


def test_the_doorway_ahead_is_closed_to_the_sonar_and_open_to_the_infrared() -> None:
    _, scans = scene("flynn_doorway_ahead")
    opening = between(scans[0], -10, 10)
    assert np.all(scans[0].ranges[opening] < 6.7 * FOOT)
    assert scans[0].infrared is not None
    assert np.all(scans[0].infrared[opening] == 30)
    beside = between(scans[0], 13, 20) | between(scans[0], -20, -13)
    assert np.all(scans[0].infrared[beside] > 0)
    assert np.all(scans[0].infrared[beside] != 30)
