"""The result folder: reports hold plain JSON, and a folder that is no result says what it lacks."""

import json
from pathlib import Path

import numpy as np
import pytest

from slam.result_folder import ResultError, folder_for, read_report, story_of, write_report


def test_numbers_that_json_does_not_know_become_null(tmp_path: Path) -> None:
    write_report(tmp_path, {"recording": {}, "scores": {"iou": np.float64(0.5), "n": np.int64(3), "bad": float("nan")}})
    assert read_report(tmp_path)["scores"] == {"iou": 0.5, "n": 3, "bad": None}
    json.loads((tmp_path / "report.json").read_text(), parse_constant=pytest.fail)


@pytest.mark.parametrize(
    ("text", "says"),
    [(None, "is no result of merge"), ("{", "is not JSON"), ("[]", "names no recording"), ("{}", "names no recording")],
)
def test_a_folder_that_is_no_result_says_what_it_lacks(tmp_path: Path, text: str | None, says: str) -> None:
    if text is not None:
        (tmp_path / "report.json").write_text(text)
    with pytest.raises(ResultError, match=says):
        story_of(tmp_path)


def test_a_map_is_named_after_its_recording_and_never_takes_the_place_of_anothers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monday, tuesday, hall = tmp_path / "mon.day.log.gz", tmp_path / "tuesday.bag", tmp_path / "hall.2"
    monday.touch()
    hall.mkdir()
    assert folder_for([monday]) == Path("mon.day-map")
    assert folder_for([hall]) == folder_for([Path("hall.2/.")]) == Path("hall.2-map")
    assert folder_for([monday, tuesday]) == Path("mon.day-and-1-more-map")
    write_report(tmp_path / "hall.2-map", {"recording": {"path": str(hall)}})
    assert folder_for([hall]) == Path("hall.2-map")
    other = tmp_path / "elsewhere" / "hall.2"
    other.mkdir(parents=True)
    with pytest.raises(ResultError, match=r"hall.2-map is the map of .*hall.2, not to be lost: name another folder"):
        folder_for([other])
