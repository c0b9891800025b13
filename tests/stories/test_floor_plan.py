"""A drawn floor becomes a plan, and the plan a recording."""

import json
from pathlib import Path

from tests.stories.command_line import run


def rectangle(left: float, bottom: float, right: float, top: float) -> dict[str, object]:
    return {"floorID": 7, "x": [left, left, right, right], "y": [bottom, top, top, bottom]}


def test_a_drawn_floor_is_driven_through_and_an_unknown_one_is_answered_with_the_known(tmp_path: Path) -> None:
    drawings, plan, recording = tmp_path / "fp.json", tmp_path / "plan.geojson", tmp_path / "drive"
    walls = [rectangle(0, 0, 6, 0.2), rectangle(0, 3.8, 6, 4), rectangle(0, 0, 0.2, 4), rectangle(5.8, 0, 6, 4)]
    drawings.write_text(json.dumps({"rect": dict(enumerate(walls)), "slab": {"0": rectangle(0, 0, 6, 4)}}))
    assert run("floor-plan", drawings, 7, "--out", plan).code == 0
    assert run("simulate", plan, "--sensor", "lidar", "--out", recording).code == 0
    assert (recording / "truth.geojson").exists()
    told = run("floor-plan", drawings, 9, "--out", plan)
    assert told.code == 1
    assert "known floors are 7" in told.err
