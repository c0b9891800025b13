"""A robot that is carried away, blinded, switched off or surrounded: the result says so, and the rest stays right."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import Polygon, box

from backend.estimate import Estimate
from frontend.rigid_motion import between, compose
from frontend.scan import Floats, Scan
from slam.mapper import Mapper
from slam.pipeline import merge_scans
from slam.settings import Settings
from slam.simulation.trajectory import in_first_frame
from slam.simulation.world import World
from tests.simulated_drives import drive, furnished_room, once_round, round_building, world_of

SETTINGS = Settings()
TRUE = in_first_frame(once_round())


@pytest.fixture(scope="module")
def scans() -> list[Scan]:
    return drive(round_building(), once_round(), seed=1)


def driven_on(first: list[Scan], second: list[Scan], pause: float = 0.5) -> list[Scan]:
    """The second drive after the first, as the wheels and the clock see it when the robot was carried in between."""
    start, last = second[0], first[-1]
    return first + [
        replace(
            scan,
            odometry=compose(last.odometry, between(start.odometry, scan.odometry)),
            time=last.time + pause + scan.time - start.time,
        )
        for scan in second
    ]


def mapped(scans: list[Scan], starts: tuple[int, ...] = ()) -> Estimate:
    mapper = Mapper(SETTINGS.frontend, SETTINGS.poses)
    for number, scan in enumerate(scans):
        if number in starts:
            mapper.begin_session("another drive")
        mapper.add(scan)
    return mapper.result()


def off(poses: Floats, true: Floats) -> float:
    """The worst distance of poses (n, 3) from the true ones."""
    return float(np.max(np.linalg.norm(poses[:, :2] - true[:, :2], axis=1)))


def told(estimate: Estimate, what: str, *, accepted: bool) -> list[tuple[int, ...]]:
    return [made.scans for made in estimate.decisions if made.what == what and made.accepted is accepted]


def test_a_robot_carried_to_a_known_place_finds_itself_again(scans: list[Scan]) -> None:
    found = mapped(driven_on(scans[:80], scans[10:45]))
    assert told(found, "place", accepted=False)[0] == (80,)
    assert len(told(found, "place", accepted=True)) == 1
    assert found.mapped.all()
    assert off(found.poses, np.vstack([TRUE[:80], TRUE[10:45]])) < 0.05


def test_a_robot_carried_elsewhere_is_told_to_be_lost_and_the_map_stays_right(scans: list[Scan]) -> None:
    stood = np.column_stack([np.linspace(2, 3, 15), np.linspace(2.4, 2.6, 15), np.linspace(0, 2, 15)])
    elsewhere = drive(furnished_room(np.random.default_rng(5)), stood, seed=2)
    merged = merge_scans(driven_on(scans[:60], elsewhere), SETTINGS)
    assert told(merged.estimate, "session", accepted=False) == [tuple(range(60, 75))]
    np.testing.assert_array_equal(merged.estimate.mapped, np.arange(75) < 60)
    assert len(merged.percepts) == len(merged.poses) == 60
    assert off(merged.poses, TRUE[:60]) < 0.04
    assert np.max(np.abs(merged.estimate.landmarks)) < 30
    assert {tie.landmark for tie in merged.estimate.landmark_ties} == set(range(len(merged.estimate.landmarks)))


def test_a_pause_that_the_wheels_bridge_is_told_and_does_no_harm(scans: list[Scan]) -> None:
    later = [replace(scan, time=scan.time + 60) for scan in scans[52:80]]
    found = mapped(scans[:50] + later)
    assert told(found, "gap", accepted=True) == [(49, 50)]
    assert off(found.poses, np.vstack([TRUE[:50], TRUE[52:80]])) < 0.04


def test_wheels_that_start_counting_anew_are_told_and_do_no_harm(scans: list[Scan]) -> None:
    reset = np.array([40.0, -7.0, 2.0])
    jumped = [replace(scan, odometry=compose(reset, scan.odometry)) for scan in scans[50:80]]
    found = mapped(scans[:50] + jumped)
    assert told(found, "gap", accepted=True) == [(49, 50)]
    assert found.mapped.all()
    assert off(found.poses, TRUE[:80]) < 0.04


def walking_past(scan: Scan, place: Floats, radius: float = 0.3) -> Scan:
    """The scan with a round body at `place` (2,) of the sensor's frame before whatever is behind it."""
    along = np.column_stack([np.cos(scan.bearings), np.sin(scan.bearings)])
    middle, aside = along @ place, along @ np.array([-place[1], place[0]])
    reached = (middle > 0) & (np.abs(aside) < radius)
    near = middle - np.sqrt(np.maximum(radius**2 - aside**2, 0))
    return replace(scan, ranges=np.where(reached, np.minimum(near, scan.ranges), scan.ranges))


def test_a_person_who_walks_along_moves_nothing(scans: list[Scan]) -> None:
    sway = 0.3 * np.sin(np.arange(len(scans)))
    accompanied = [walking_past(scan, np.array([0.9, shift])) for scan, shift in zip(scans, sway, strict=True)]
    found = mapped(accompanied)
    assert found.mapped.all()
    assert off(found.poses, TRUE) < 0.05


def test_two_drives_with_unknown_starts_become_one_map(scans: list[Scan]) -> None:
    second = drive(round_building(), once_round()[20:70], seed=9)
    found = mapped(scans[:60] + [replace(scan, time=scan.time + 100) for scan in second], starts=(60,))
    assert found.mapped.all()
    assert off(found.poses, np.vstack([TRUE[:60], TRUE[20:70]])) < 0.05


def test_a_drive_through_another_building_is_left_out_with_the_reason(scans: list[Scan]) -> None:
    stood = np.column_stack([np.linspace(2, 3.5, 12), np.full(12, 2.5), np.zeros(12)])
    other = drive(furnished_room(np.random.default_rng(7)), stood, seed=3)
    found = mapped(scans[:40] + [replace(scan, time=scan.time + 100) for scan in other], starts=(40,))
    reasons = [made.reason for made in found.decisions if made.what == "session"]
    assert reasons == ["none of its 12 scans was recognised in the map: they are left out of it"]
    assert found.mapped.sum() == 40


def rooms_apart(rng: np.random.Generator) -> tuple[World, Floats]:
    """Two furnished rooms at the ends of a bare corridor of 26 m, and a way (p, 3) from the one into the other."""
    places = rng.uniform((0.2, 0.2), (1.2, 3.8), (3, 2)) + np.array([[0, 0], [2.6, 0], [33, 0]])
    boxes = [box(x, y, x + rng.uniform(0.4, 0.9), y + rng.uniform(0.4, 0.9)) for x, y in places]
    right = [(0, 0), (5, 0), (5, 1.6), (31, 1.6), (31, 0), (36, 0)]
    rooms = Polygon([*right, *((x, 5 - y) for x, y in reversed(right))])
    along = np.arange(2.2, 33, 0.6)
    return world_of(rooms, *boxes), np.column_stack([along, np.full(len(along), 2.5), np.zeros(len(along))])


def test_wheels_that_stand_still_through_a_bare_corridor_are_told_and_both_its_ends_are_right() -> None:
    """Nothing but the robot's pace says how long the corridor is: it is told, and what is left of it is doubted."""
    world, way = rooms_apart(np.random.default_rng(0))
    found = mapped([replace(scan, odometry=np.zeros(3)) for scan in drive(world, way, 0)])
    told_of = [made.scans[-1] for made in found.decisions if "along the corridor" in made.reason]
    assert len(told_of) > 10
    assert all(4 < way[scan, 0] < 32 for scan in told_of)
    for inside in (way[:, 0] < 5, way[:, 0] > 32):
        first, *rest = np.flatnonzero(inside)
        apart = [between(found.poses[first], found.poses[scan])[0] for scan in rest]
        np.testing.assert_allclose(apart, way[rest, 0] - way[first, 0], atol=0.1)
    assert np.max(np.abs(found.poses[:, 1])) < 0.1
