"""The room map as GeoJSON: written and read back it is the same map, and foreign plans can be planned on too."""

import json
from pathlib import Path

import numpy as np
import pytest
from shapely import MultiPolygon, Polygon, box

from backend.room_map import Door, MapEdge, MapEdgeKind, Obstacle, RoomMap
from slam.room_file import RoomFileError, free_space, points_of_kind, read_features, read_room, room_text

ROOM = RoomMap(
    free=MultiPolygon([Polygon(box(0, 0, 6, 4).exterior, [box(2, 2, 3, 3).exterior.coords])]),
    safety=MultiPolygon([box(0.1, 0.1, 5.9, 1.9)]),
    edges=(
        MapEdge((0.0, 0.0), (6.0, 0.0), MapEdgeKind.REAL, 7, 1, 0.0125, np.array([0, 2, 5])),
        MapEdge((6.0, 0.0), (6.0, 4.0), MapEdgeKind.FRONTIER, 0, 0, float("inf"), np.array([], dtype=np.int64)),
    ),
    doors=(Door("north", np.array([[1.0, 4.0], [1.9, 4.0]]), 0.75, np.array([1])),),
    obstacles=(Obstacle(box(2, 2, 3, 3), True, 0, np.array([3])),),
    leaks=np.array([[5.0, 0.5]]),
    leak_reasons=("2 views measured it, 3 saw through it: it came after view 4",),
)


def written(folder: Path, text: str) -> Path:
    path = folder / "map.geojson"
    path.write_text(text)
    return path


def test_a_map_read_back_is_the_map_that_was_written(tmp_path: Path) -> None:
    path = written(tmp_path, room_text(ROOM, np.array([[0.5, 0.25]])))
    read = read_room(path)
    assert read.free.equals(ROOM.free)
    assert read.safety.equals(ROOM.safety)
    for mine, other in zip(read.edges, ROOM.edges, strict=True):
        assert (mine.start, mine.end, mine.kind, mine.support) == (other.start, other.end, other.kind, other.support)
        assert (mine.contradictions, mine.spread) == (other.contradictions, other.spread)
        assert np.array_equal(mine.views, other.views)
    assert read.doors[0].name == "north"
    assert read.doors[0].width == pytest.approx(0.9)
    assert read.obstacles[0].inferred
    assert np.array_equal(read.leaks, ROOM.leaks)
    assert read.leak_reasons == ROOM.leak_reasons
    assert np.array_equal(points_of_kind(read_features(path), "landmark"), [[0.5, 0.25]])


def test_every_feature_has_a_kind_and_edges_their_provenance() -> None:
    features = json.loads(room_text(ROOM, np.zeros((1, 2))))["features"]
    kinds = {feature["properties"]["kind"] for feature in features}
    assert kinds == {"free", "safety", "wall edge", "frontier", "door", "obstacle", "landmark", "leak"}
    for feature in features:
        if feature["properties"]["kind"] in {"wall edge", "frontier"}:
            assert {"support", "contradictions", "spread", "views"} <= feature["properties"].keys()


def test_plans_use_the_safety_layer_unless_asked_otherwise(tmp_path: Path) -> None:
    path = written(tmp_path, room_text(ROOM, np.zeros((0, 2))))
    assert free_space(path, "safety")[0].area == pytest.approx(5.8 * 1.8)
    assert free_space(path, "free")[0].area == pytest.approx(23)


def plan(*parts: tuple[str, Polygon]) -> str:
    features = [
        {"type": "Feature", "properties": {"kind": kind}, "geometry": shape.__geo_interface__} for kind, shape in parts
    ]
    return json.dumps({"type": "FeatureCollection", "features": features})


def test_a_boundary_with_obstacles_is_a_plan_too(tmp_path: Path) -> None:
    path = written(
        tmp_path, plan(("boundary", box(0, 0, 4, 4)), ("obstacle", box(1, 1, 2, 2)), ("door", box(0, 0, 1, 1)))
    )
    free, kind = free_space(path, "safety")
    assert free.area == pytest.approx(15)
    assert kind == "boundary"


def test_an_empty_safety_layer_is_not_replaced_by_another(tmp_path: Path) -> None:
    path = written(tmp_path, plan(("free", box(0, 0, 4, 4)), ("safety", Polygon())))
    with pytest.raises(RoomFileError, match="its safety leaves no area free"):
        free_space(path, "safety")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("{", "is not JSON"),
        ("[]", "not a GeoJSON FeatureCollection"),
        ('{"features": [{"geometry": {"type": "Blob", "coordinates": []}}]}', "not a GeoJSON FeatureCollection"),
        (plan(("door", box(0, 0, 1, 1))), "no feature of kind safety, free or boundary, only door"),
    ],
)
def test_what_is_no_map_is_said(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(RoomFileError, match=says):
        free_space(written(tmp_path, text), "safety")


def test_a_map_without_provenance_is_not_taken_for_ours(tmp_path: Path) -> None:
    with pytest.raises(RoomFileError, match="lacks the property 'inferred'"):
        read_room(written(tmp_path, plan(("obstacle", box(0, 0, 1, 1)))))


def test_a_leak_that_gives_no_reason_is_refused_with_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(RoomFileError, match=r"lacks the property 'reason'.*run merge again"):
        read_room(written(tmp_path, plan(("free", box(0, 0, 1, 1)), ("leak", box(0, 0, 1, 1)))))
