"""A click's answer: the planner's own, and what shows it on the map."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from shapely import box
from shapely.geometry import mapping

from slam.planning import PLANNERS
from slam.serve.routes import Question, route

DOORWAY = 0.8
ROOMS = shapely.union_all([box(0, 0, 4, 4), box(4, 1.5, 4.2, 1.5 + DOORWAY), box(4.2, 0, 8, 4)])


@pytest.fixture
def map_file(tmp_path: Path) -> Path:
    feature = {"type": "Feature", "properties": {"kind": "safety"}, "geometry": mapping(ROOMS)}
    path = tmp_path / "map.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
    return path


@pytest.mark.parametrize("planner", PLANNERS)
def test_an_answer_carries_the_path_and_the_time_it_took(map_file: Path, planner: str) -> None:
    (answer,) = route(map_file, Question(planner, "disc:0.2", (1, 1), (7, 3)))
    assert answer["answer"] == "path"
    np.testing.assert_allclose([answer["poses"][0][:2], answer["poses"][-1][:2]], [(1, 1), (7, 3)])
    assert answer["seconds"] > 0
    assert answer["outline"]["radius"] == 0.2
    assert answer["gap"] is None


def test_a_proof_that_there_is_no_way_shows_the_place_that_is_too_narrow(map_file: Path) -> None:
    (answer,) = route(map_file, Question("configuration-space", "disc:0.5", (1, 1), (7, 3)))
    assert answer["answer"] == "no path"
    gap = answer["gap"]
    here, there = np.array(gap["narrowest"])
    assert gap["width"] == pytest.approx(DOORWAY)
    assert gap["needed"] == pytest.approx(1.0)
    assert np.hypot(*(there - here)) == pytest.approx(DOORWAY)
    assert sorted([here[1], there[1]]) == pytest.approx([1.5, 1.5 + DOORWAY])
