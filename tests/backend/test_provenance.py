"""Claims about the labels of the map's edges."""

import numpy as np
import pytest
from shapely import MultiPolygon, box

from backend.ballots import ballot_of
from backend.evidence import EvidenceGrid
from backend.provenance import boundary_edges, label_edges
from backend.room_map import MapEdgeKind
from tests.backend.placed_samples import joined, wall_samples

ROOM = MultiPolygon([box(0, 0, 3, 2)])
FLOOR = (np.array([0.0, 0.0]), np.array([3.0, 0.0]))


def grid_of_rooms(*heights: float) -> EvidenceGrid:
    grid = EvidenceGrid(0.025)
    for low in heights:
        ring = np.array([[0.0, low], [3.0, low], [3.0, 2.0], [0.0, 2.0]])
        grid.cast(ballot_of(ring, np.zeros(4, dtype=bool), np.array([1.5, 1.0]), 0.06, 0.025), 1)
    return grid


def test_the_free_space_lies_on_the_left_of_every_edge() -> None:
    edges = boundary_edges(ROOM)
    along = edges[:, 1] - edges[:, 0]
    left = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    inward = edges.mean(axis=1) + 0.1 * left
    assert np.all((inward > 0) & (inward < [3, 2]))


def test_support_counts_distinct_views_on_the_facing_side_only() -> None:
    rng = np.random.default_rng(0)
    inside = wall_samples(*FLOOR, 5, 0.01, rng)
    outside = wall_samples(FLOOR[1], FLOOR[0], 9, 0.01, rng)
    edges = label_edges(boundary_edges(ROOM), joined(inside, outside), grid_of_rooms(0.0).counts(), 0.06)
    support = {edge.support for edge in edges if edge.kind == MapEdgeKind.REAL}
    assert support == {5}
    assert sum(edge.kind == MapEdgeKind.FRONTIER for edge in edges) == 3


def test_contradictions_count_the_views_that_saw_through() -> None:
    samples = wall_samples(*FLOOR, 5, 0.01, np.random.default_rng(1))
    edges = label_edges(boundary_edges(ROOM), samples, grid_of_rooms(0.0, -0.5, -0.7).counts(), 0.06)
    floor = next(edge for edge in edges if edge.kind == MapEdgeKind.REAL)
    assert floor.contradictions == 2
    assert 0.002 < floor.spread < 0.03


def test_an_edge_measured_in_part_is_real_only_there() -> None:
    samples = wall_samples(np.array([1.0, 0.0]), np.array([2.0, 0.0]), 5, 0.01, np.random.default_rng(2))
    edges = label_edges(boundary_edges(ROOM), samples, grid_of_rooms(0.0).counts(), 0.06)
    real = [edge for edge in edges if edge.kind == MapEdgeKind.REAL]
    assert len(edges) == 6
    assert [(edge.start[0] - 0.94, edge.end[0] - 2.06) for edge in real] == [pytest.approx((0, 0), abs=0.06)]
    assert {(edge.end in {other.start for other in edges}) for edge in edges} == {True}


def test_cutting_edges_loses_no_length() -> None:
    samples = wall_samples(np.array([1.0, 0.0]), np.array([2.0, 0.0]), 5, 0.01, np.random.default_rng(2))
    edges = label_edges(boundary_edges(ROOM), samples, grid_of_rooms(0.0).counts(), 0.06)
    assert sum(np.hypot(e.end[0] - e.start[0], e.end[1] - e.start[1]) for e in edges) == pytest.approx(10.0)


def test_a_lone_sample_at_an_edges_end_supports_no_more_than_that_end() -> None:
    corner = wall_samples(np.array([0.0, 0.0]), np.array([0.02, 0.0]), 1, 0.0, np.random.default_rng(2))
    edges = label_edges(boundary_edges(ROOM), corner, grid_of_rooms(0.0).counts(), 0.06)
    assert sum(edge.end[0] - edge.start[0] for edge in edges if edge.kind == MapEdgeKind.REAL) == pytest.approx(0.06)
