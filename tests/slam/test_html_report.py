import json
from html.parser import HTMLParser
from pathlib import Path

import pytest

from slam.html_report import PAGE, page
from tests.stories.command_line import run

BASEMENT = Path("datasets/flynn_basement")


class Reader(HTMLParser):
    """Notes tags that stay open, everything the page would fetch, and its text."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.fetched: list[str] = []
        self.words: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "img", "br"):
            self.open.append(tag)
        self.fetched += [value or "" for name, value in attrs if name in ("src", "href")]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def _read(text: str) -> Reader:
    reader = Reader()
    reader.feed(text)
    reader.close()
    return reader


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report") / "run"
    assert run("merge", BASEMENT, "--out", folder).code == 0
    return folder


def test_the_page_is_whole_and_fetches_nothing(result: Path) -> None:
    reader = _read((result / PAGE).read_text())
    assert reader.open == []
    assert reader.fetched
    assert all(source.startswith("data:image/png;base64,") for source in reader.fetched)


def test_the_page_says_what_was_planned_counted_and_refused(result: Path) -> None:
    report = json.loads((result / "report.json").read_text())
    report["rejected"] = [{"what": "loop", "scans": [0, 2], "reason": "<63% of the scan> lies on the old map"}]
    (result / "report.json").write_text(json.dumps(report))
    words = " ".join(_read(page(result)).words)
    for said in ["flynn_basement", "cones", "clearance (m)", "free area", "merging", "0, 2", "<63% of the scan> lies"]:
        assert said in words
    assert "who saw it" in words


def test_scores_come_onto_the_page_when_they_are_made(result: Path) -> None:
    assert "Scores" not in (result / PAGE).read_text()
    assert run("score", result, "--poses", BASEMENT / "true.tum").code == 0
    assert "Scores: poses" in (result / PAGE).read_text()
