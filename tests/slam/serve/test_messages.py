"""Messages to the page: what goes in comes out, whatever it is."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from shapely import MultiPolygon, Polygon, box

from backend.room_map import MapEdge, MapEdgeKind, Obstacle, RoomMap
from slam.serve.messages import Arrays, kind_of, pack, poses_message, rings_of, room_message, unpack, upper

SQUARE = Polygon(box(0, 0, 4, 3).exterior, [box(1, 1, 2, 2).exterior])
ROOM = RoomMap(
    free=MultiPolygon([SQUARE]),
    safety=MultiPolygon([box(0.1, 0.1, 0.9, 2.9)]),
    edges=(
        MapEdge((0, 0), (4, 0), MapEdgeKind.REAL, 3, 1, 0.01, np.array([0, 2, 5])),
        MapEdge((4, 0), (4, 3), MapEdgeKind.FRONTIER, 0, 0, float("inf"), np.array([], np.int64)),
    ),
    doors=(),
    obstacles=(Obstacle(box(1, 1, 2, 2), True, 2, np.array([0, 5])),),
    leaks=np.empty((0, 2)),
)

MAPPED = np.array([True, False, True, True, True, True, True])


@settings(deadline=None, max_examples=40)
@given(
    st.dictionaries(
        st.sampled_from(["ring", "edges", "views"]),
        st.one_of(
            arrays.arrays(np.float64, arrays.array_shapes(max_dims=2, min_side=0), elements=st.floats(width=32)),
            arrays.arrays(np.uint8, st.integers(0, 9)),
            arrays.arrays(np.int64, st.integers(0, 9), elements=st.integers(-(2**31), 2**31 - 1)),
        ),
    ),
    st.text(max_size=20),
)
def test_whatever_is_packed_comes_out_again(given_arrays: Arrays, says: str) -> None:
    head, found = unpack(pack("scan", {"says": says}, given_arrays))
    assert head == {"kind": "scan", "says": says}
    assert found.keys() == given_arrays.keys()
    for name, array in given_arrays.items():
        assert np.array_equal(found[name], array, equal_nan=array.dtype.kind == "f")


def test_arrays_lie_where_a_browser_may_look_at_them() -> None:
    message = pack("any", {}, {"bytes": np.array([1, 2, 3], np.uint8), "floats": np.array([0.5])})
    start = 4 + int.from_bytes(message[:4], "little")
    assert start % 4 == 0
    assert message[start + 4 :] == np.array([0.5], np.float32).tobytes()


def test_a_room_keeps_its_edges_with_their_provenance() -> None:
    head, found = unpack(room_message(ROOM, MAPPED, np.empty((0, 2)), final=True))
    assert head["kind"] == kind_of(room_message(ROOM, MAPPED, np.empty((0, 2)), final=True)) == "room"
    assert head["views"] == 7
    assert head["area"] == 11
    assert found["support"].tolist() == [3, 0]
    assert found["contradictions"].tolist() == [1, 0]
    assert found["spread"].tolist() == [np.float32(0.01), -1]  # no bound is told as −1
    assert found["seenBy"].tolist() == [0, 3, 6]  # scan 1 stands not in the map
    assert found["seenCount"].tolist() == [3, 0]
    assert head["obstacles"] == [{"inferred": True, "support": 2, "views": [0, 6]}]


def test_the_rings_of_an_area_rebuild_it() -> None:
    found = rings_of("free", [MultiPolygon([SQUARE, box(7, 7, 8, 8)])])
    rings = np.split(found["free"], np.cumsum(found["freeCounts"])[:-1])
    areas = shapely.area([Polygon(ring) for ring in rings])
    assert sorted(areas) == [1, 1, 12]
    assert found["freeOwners"].tolist() == [0, 0, 0]


def test_only_what_a_picture_needs_of_a_covariance_is_sent() -> None:
    assert upper(np.array([[[1.0, 2.0], [2.0, 3.0]]])).tolist() == [[1, 2, 3]]
    covariances = np.diag([1.0, 2.0, 3.0])[None]
    assert unpack(poses_message(np.zeros((1, 3)), covariances))[1]["doubts"].tolist() == [[1, 0, 2]]
