"""Claims about the record of decisions."""

import pickle

import numpy as np
from shapely import Point, box

from backend.polygon_merging import Merger
from backend.room_map import RoomMap, Verdict
from tests.backend.plan_rays import Plan, Rays, view_of

PILLAR = Point(3.0, 2.0).buffer(0.25)
ROOM = box(0, 0, 6, 4)
POSES = np.array([[1.0, 0.8, 0.0], [5.0, 0.8, 0.0], [3.0, 3.5, 0.0], [4.8, 3.2, 0.0]])


def map_with_a_pillar_only_the_first_view_met() -> RoomMap:
    rng = np.random.default_rng(0)
    merger = Merger()
    for index, pose in enumerate(POSES):
        free = ROOM.difference(PILLAR) if index == 0 else ROOM
        plan = Plan(free, np.empty((0, 2, 2)), ())  # type: ignore[arg-type]
        merger.add(view_of(plan, pose, Rays(), rng), pose, 10 + index)
    return merger.result()


def test_what_one_view_met_and_the_others_saw_through_is_contradicted_by_them() -> None:
    room_map = map_with_a_pillar_only_the_first_view_met()
    assert room_map.obstacles == ()
    met = [made for made in room_map.decisions if made.verdict == Verdict.CONTRADICTED]
    assert met
    assert all(made.owners.tolist() == [10] for made in met)
    assert set(np.concatenate([made.deciders for made in met])) <= {11, 12, 13}
    assert all(PILLAR.buffer(0.15).intersects(Point(made.piece.mean(axis=0))) for made in met)


def test_filler_edges_vanish_where_another_view_saw_behind_them() -> None:
    room_map = map_with_a_pillar_only_the_first_view_met()
    behind = [made for made in room_map.decisions if made.verdict == Verdict.SEEN_BEHIND]
    assert behind
    assert all(len(made.deciders) >= 1 and 10 not in made.deciders for made in behind if made.owners[0] == 10)


def test_every_edge_of_every_view_is_decided_once() -> None:
    room_map = map_with_a_pillar_only_the_first_view_met()
    kept = sum(len(made.piece) - 1 for made in room_map.decisions if made.owners.tolist() == [12])
    assert kept >= 360
    walls = [made for made in room_map.decisions if made.verdict == Verdict.KEPT]
    assert all(len(made.deciders) for made in walls)


def test_a_map_with_its_decisions_can_be_sent_to_another_process() -> None:
    room_map = map_with_a_pillar_only_the_first_view_met()
    sent = pickle.loads(pickle.dumps(room_map))
    assert len(sent.decisions) == len(room_map.decisions) > 0
    assert sent.decisions[0].verdict == room_map.decisions[0].verdict
