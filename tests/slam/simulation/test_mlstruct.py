import json
from pathlib import Path

import pytest
from shapely import box

from slam.simulation.mlstruct import convert_mlstruct
from slam.simulation.world import PlanError, build_world


def rectangle(left: float, bottom: float, right: float, top: float, floor: int) -> dict[str, object]:
    return {"floorID": floor, "x": [left, left, right, right], "y": [bottom, top, top, bottom]}


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    """Floor 7: two rooms with a door between them and a window. Floor 8: another."""
    walls = [
        rectangle(0, 0, 8, 0.2, 7), rectangle(0, 3.8, 8, 4, 7), rectangle(0, 0, 0.2, 4, 7),
        rectangle(7.8, 0, 8, 1, 7), rectangle(7.8, 2, 8, 4, 7), rectangle(4, 0.2, 4.1, 2.5, 7),
        rectangle(0, 0, 1, 1, 8),
    ]  # fmt: skip
    slabs = [rectangle(0, 0, 8, 4, 7), rectangle(0, 0, 9, 9, 8)]
    file = tmp_path / "fp.json"
    file.write_text(json.dumps({"rect": dict(enumerate(walls)), "slab": dict(enumerate(slabs))}))
    return file


def test_a_floor_becomes_a_plan_whose_window_is_closed_by_the_slab(drawing: Path) -> None:
    world = build_world(convert_mlstruct(drawing, 7))
    assert world.free.area == pytest.approx(7.6 * 3.6 - 0.1 * 2.3 + 0.2, abs=1e-3)
    assert world.free.within(box(0, 0, 8, 4))
    assert world.drive is not None


def test_a_floor_that_is_not_there_is_refused_with_those_that_are(drawing: Path) -> None:
    with pytest.raises(PlanError, match=r"has no rect on floor 9, known floors are 7, 8"):
        convert_mlstruct(drawing, 9)


@pytest.mark.parametrize("content", ["[]", '{"rect": {"a": {"x": [1, 2], "y": [1]}}}', '{"rect": [1]}'])
def test_json_of_another_kind_is_refused_with_what_is_looked_for(tmp_path: Path, content: str) -> None:
    (tmp_path / "fp.json").write_text(content)
    with pytest.raises(PlanError, match=r'is no fp\.json of MLSTRUCT-FP, which holds shapes "rect" and "slab"'):
        convert_mlstruct(tmp_path / "fp.json", 7)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PlanError, match="cannot be read as JSON"):
        convert_mlstruct(tmp_path / "none.json", 7)
