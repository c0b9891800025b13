"""The result folder: reports hold plain JSON, and a folder that is no result says what it lacks."""

import json
from pathlib import Path

import numpy as np
import pytest

from slam.result_folder import ResultError, read_report, story_of, write_report


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
