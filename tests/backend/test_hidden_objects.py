"""Claims about objects, measured and inferred."""

import numpy as np
from shapely import MultiPolygon, Point, Polygon, box

from backend.contours import as_polygons
from backend.hidden_objects import ObjectSettings, objects_in, without_slivers
from backend.polygon_merging import merge_views
from backend.provenance import boundary_edges
from backend.room_map import MapEdge, MapEdgeKind
from backend.sight import sight_of
from tests.backend.plan_rays import Plan, Rays, view_of

SETTINGS = ObjectSettings()
SIGHT = sight_of([np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]])], np.array([[1.0, 1.0]]))


def labelled(free: MultiPolygon, kind: MapEdgeKind) -> tuple[MapEdge, ...]:
    views = np.array([3, 5]) if kind == MapEdgeKind.REAL else np.empty(0, dtype=np.int64)
    return tuple(MapEdge(tuple(a), tuple(b), kind, len(views), 0, 0.0, views) for a, b in boundary_edges(free).tolist())


def test_a_hole_with_seen_surface_is_measured_and_one_without_is_inferred() -> None:
    free = as_polygons(box(0, 0, 5, 4).difference(box(2, 2, 2.5, 2.5)))
    (measured,) = objects_in(free, labelled(free, MapEdgeKind.REAL), SIGHT, SETTINGS)
    (inferred,) = objects_in(free, labelled(free, MapEdgeKind.FRONTIER), SIGHT, SETTINGS)
    assert (measured.inferred, measured.support, measured.views.tolist()) == (False, 2, [3, 5])
    assert (inferred.inferred, inferred.support) == (True, 0)


def test_walls_between_rooms_are_no_objects() -> None:
    free = as_polygons(box(0, 0, 5, 4).difference(box(1, 2, 4, 2.1)))
    assert objects_in(free, labelled(free, MapEdgeKind.REAL), SIGHT, SETTINGS) == ()


def test_a_notch_nobody_saw_is_inferred_and_a_seen_one_is_not() -> None:
    free = as_polygons(box(0, 0, 5, 4).difference(box(2, 3.6, 2.4, 4.0)))
    assert objects_in(free, labelled(free, MapEdgeKind.REAL), SIGHT, SETTINGS) == ()
    (pocket,) = objects_in(free, labelled(free, MapEdgeKind.FRONTIER), SIGHT, SETTINGS)
    assert pocket.inferred
    assert pocket.outline.symmetric_difference(box(2, 3.6, 2.4, 4.0)).area < 1e-6


def test_a_notch_seen_along_its_sides_only_is_a_shadow() -> None:
    free = as_polygons(box(0, 0, 5, 4).difference(Polygon([(2, 4), (2.2, 3), (2.4, 4)])))
    below = sight_of([np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]])], np.array([[2.2, 0.1]]))
    assert objects_in(free, labelled(free, MapEdgeKind.FRONTIER), below, SETTINGS) == ()


def test_small_holes_stay_only_where_something_was_measured() -> None:
    free = as_polygons(box(0, 0, 5, 4).difference(box(1, 1, 1.05, 1.05)).difference(box(3, 3, 3.05, 3.05)))
    kept = without_slivers(free, np.array([[1.0, 1.02]]), 0.06, SETTINGS)
    assert [len(part.interiors) for part in kept.geoms] == [1]
    assert kept.contains(Point(3.02, 3.02))


def test_a_round_obstacle_seen_from_three_sides_becomes_one_closed_object() -> None:
    rng = np.random.default_rng(0)
    pillar = Point(3.0, 2.0).buffer(0.25)
    plan = Plan(box(0, 0, 6, 4).difference(pillar), np.empty((0, 2, 2)), (pillar,))  # type: ignore[arg-type]
    poses = np.array([[1.0, 0.8, 0.0], [5.0, 0.8, 0.0], [3.0, 3.5, 0.0]])
    room_map = merge_views([view_of(plan, pose, Rays(), rng) for pose in poses], poses)
    (thing,) = room_map.obstacles
    assert not thing.inferred
    assert thing.support == 3
    assert thing.outline.intersection(pillar).area / thing.outline.union(pillar).area > 0.75
    assert len(room_map.free.geoms) == 1


def test_the_inside_of_a_wall_between_two_rooms_is_no_hidden_object() -> None:
    free = as_polygons(box(0, 0, 3, 4).union(box(3.1, 0, 6, 4)).union(box(2.9, 1.5, 3.2, 2.4)))
    assert objects_in(free, labelled(free, MapEdgeKind.REAL), SIGHT, SETTINGS) == ()
