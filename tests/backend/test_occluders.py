"""Claims about bodies of which nobody saw the back."""

import numpy as np
import pytest
from shapely import Polygon, box
from shapely.affinity import rotate
from shapely.geometry import Point

from backend.polygon_merging import merge_views
from backend.room_map import RoomMap
from tests.backend.plan_rays import Plan, Rays, view_of

ROOM = box(0, 0, 6, 4)
PLACES = np.array([[0.8, 1.2, 0.0], [0.8, 2.0, 0.0], [0.8, 2.8, 0.0]])


def seen_from_the_left(body: Polygon) -> RoomMap:
    rng = np.random.default_rng(0)
    free = ROOM.difference(body)
    assert isinstance(free, Polygon)
    plan = Plan(free, np.empty((0, 2, 2)), (body,))
    return merge_views([view_of(plan, pose, Rays(), rng) for pose in PLACES], PLACES)


@pytest.mark.parametrize(
    "body",
    [Point(4.2, 2.0).buffer(0.35), rotate(box(3.9, 1.7, 4.5, 2.3), 45)],
    ids=["a round thing seen by half", "a box seen by two of its sides"],
)
def test_a_body_with_an_unseen_back_is_closed(body: Polygon) -> None:
    (thing,) = seen_from_the_left(body).obstacles
    assert thing.inferred
    assert thing.support == 3
    assert thing.outline.intersection(body).area / thing.outline.union(body).area > 0.45


def test_the_ground_behind_it_stays_unknown() -> None:
    room_map = seen_from_the_left(Point(4.2, 2.0).buffer(0.35))
    assert not room_map.free.contains(Point(5.5, 2.0))


def test_the_inferred_body_holds_no_ground_that_somebody_saw_free() -> None:
    room_map = seen_from_the_left(Point(4.2, 2.0).buffer(0.35))
    assert all(thing.outline.intersection(room_map.free).area < 1e-6 for thing in room_map.obstacles)


def test_a_cupboard_against_the_wall_casts_no_shadow_on_both_sides() -> None:
    assert seen_from_the_left(box(3.0, 3.5, 4.0, 4.0)).obstacles == ()
