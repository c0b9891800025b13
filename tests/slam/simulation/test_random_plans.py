import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString

from slam.simulation.random_plans import FloorRules, random_plan
from slam.simulation.world import build_world


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000), st.integers(3, 12))
def test_a_random_floor_has_its_rooms_and_a_drive_through_all_of_them_that_touches_nothing(
    seed: int, rooms: int
) -> None:
    world = build_world(random_plan(seed, rooms))
    assert len(world.rooms) == rooms
    assert world.drive is not None
    way = LineString(world.drive.waypoints)
    assert world.free.buffer(1e-6).contains(way.buffer(0.3))
    assert all(way.intersects(room) for room in world.rooms)
    assert len(world.doors) >= rooms - 1


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 10_000), st.integers(3, 12))
def test_rooms_of_a_random_floor_never_overlap_and_are_wide_enough_to_live_in(seed: int, rooms: int) -> None:
    boxes = build_world(random_plan(seed, rooms)).rooms
    assert all(a.distance(b) >= 0.0999 for i, a in enumerate(boxes) for b in boxes[:i])
    assert all(min(b.bounds[2] - b.bounds[0], b.bounds[3] - b.bounds[1]) > 1.4 for b in boxes)


def test_the_same_seed_draws_the_same_floor_and_another_one_another() -> None:
    assert random_plan(4, 6) == random_plan(4, 6)
    assert random_plan(4, 6) != random_plan(5, 6)


def test_rules_make_floors_emptier_and_fuller() -> None:
    def things(mean: float) -> int:
        plan = random_plan(1, 8, FloorRules(things_per_room=mean))
        return sum(part["properties"]["kind"] == "obstacle" for part in plan["features"])

    assert things(0.0) == 0
    assert things(12.0) > things(3.0) > 0


def test_a_floor_of_no_rooms_is_refused() -> None:
    with pytest.raises(ValueError, match="3 to 12 rooms, not 2"):
        random_plan(0, 2)
