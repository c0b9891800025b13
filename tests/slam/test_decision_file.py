"""Claims about the file of decisions."""

import json
from pathlib import Path

import numpy as np
import pytest

from backend.room_map import Decision, Verdict
from slam.decision_file import decisions_text, read_decisions
from slam.room_file import RoomFileError


def test_decisions_come_back_with_their_views(tmp_path: Path) -> None:
    made = [
        Decision(verdict, np.array([[0.0, 0.0], [1.0, 0.5], [2.0, float(verdict)]]), np.array([1]), np.arange(verdict))
        for verdict in Verdict
    ]
    path = tmp_path / "decisions.geojson"
    path.write_text(decisions_text(made))
    for before, after in zip(made, read_decisions(path), strict=True):
        assert before.verdict == after.verdict
        np.testing.assert_allclose(after.piece, before.piece)
        np.testing.assert_array_equal(after.owners, before.owners)
        np.testing.assert_array_equal(after.deciders, before.deciders)


def test_a_file_of_other_features_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "decisions.geojson"
    point = {"type": "Point", "coordinates": [0, 0]}
    line = {"type": "LineString", "coordinates": [[0, 0], [1, 0]]}
    for place, told in ((point, "not a Point"), (line, "verdict")):
        path.write_text(json.dumps({"features": [{"properties": {"kind": "free"}, "geometry": place}]}))
        with pytest.raises(RoomFileError, match=told):
            read_decisions(path)


@pytest.mark.parametrize("says", [{"owners": ["a"]}, {"owners": None}, {"verdict": [1]}])
def test_damaged_views_and_verdicts_are_one_sentence(tmp_path: Path, says: dict[str, object]) -> None:
    path = tmp_path / "decisions.geojson"
    whole = {"verdict": "kept", "owners": [0], "deciders": [1]} | says
    line = {"type": "LineString", "coordinates": [[0, 0], [1, 0]]}
    path.write_text(json.dumps({"features": [{"properties": whole, "geometry": line}]}))
    with pytest.raises(RoomFileError, match="decision"):
        read_decisions(path)
