"""Truth beside a map: how far each wall is from it, and where it is looked for."""

from pathlib import Path

import numpy as np
import pytest
from shapely import box

from backend.room_map import MapEdge, MapEdgeKind
from slam.serve.truth import Truth, edge_errors


def edge(start: tuple[float, float], end: tuple[float, float], kind: MapEdgeKind = MapEdgeKind.REAL) -> MapEdge:
    return MapEdge(start, end, kind, 1, 0, 0.01, np.array([0]))


def test_a_wall_is_as_wrong_as_it_lies_off_and_a_frontier_claims_nothing() -> None:
    edges = (edge((1, 0), (3, 0)), edge((1, 0.1), (3, 0.1)), edge((1, 0), (1, 1), MapEdgeKind.FRONTIER))
    assert edge_errors(edges, box(0, 0, 4, 3).boundary) == pytest.approx([0, 0.1, -1])


def test_truth_is_only_what_lies_there(tmp_path: Path) -> None:
    assert Truth.beside(tmp_path) == Truth(None, None)
    (tmp_path / "true.tum").write_text("")
    assert Truth.beside(tmp_path) == Truth(None, tmp_path / "true.tum")
