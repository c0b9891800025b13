"""An interrupted run through the command line: one sentence says how to go on, and the same command does."""

from collections.abc import Iterator
from pathlib import Path
from unittest.mock import Mock

import pytest

from frontend.scan import Scan
from slam.commands import merge
from slam.figures import gallery
from tests.stories.command_line import run

BASEMENT = Path(__file__).parents[2] / "datasets" / "flynn_basement"


def interrupted(scans: tuple[Scan, ...]) -> Iterator[Scan]:
    yield from scans[:2]
    raise KeyboardInterrupt


def test_after_an_interruption_the_same_command_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out, checkpoint = tmp_path / "run", tmp_path / "run.checkpoint"
    with monkeypatch.context() as patch:
        patch.setattr(merge, "progress", interrupted)
        stopped = run("merge", BASEMENT, "--out", out)
    assert stopped.code == 130
    assert stopped.err.splitlines() == [f"stopped after scan 2 of 3: the same command goes on from {checkpoint}"]
    assert not out.exists()
    done = run("merge", BASEMENT, "--out", out)
    assert done.code == 0
    assert f"going on after scan 2 of 3, from {checkpoint}" in done.err
    assert not checkpoint.exists()
    assert run("merge", BASEMENT, "--out", tmp_path / "whole").code == 0
    assert (out / "trajectory.tum").read_bytes() == (tmp_path / "whole" / "trajectory.tum").read_bytes()
    assert (out / "map.geojson").read_bytes() == (tmp_path / "whole" / "map.geojson").read_bytes()


def test_an_interruption_while_figures_are_drawn_loses_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with monkeypatch.context() as patch:
        patch.setattr(gallery, "draw", Mock(side_effect=KeyboardInterrupt))
        stopped = run("merge", BASEMENT)
    assert stopped.code == 130
    assert stopped.err == "stopped after scan 3 of 3: the same command goes on from flynn_basement-map.checkpoint\n"
    assert [path.name for path in tmp_path.iterdir()] == ["flynn_basement-map.checkpoint"]
    assert "going on after scan 3 of 3" in run("merge", BASEMENT).err
    assert [path.name for path in tmp_path.iterdir()] == ["flynn_basement-map"]


def test_a_checkpoint_of_another_run_is_told_and_left_behind(tmp_path: Path) -> None:
    (tmp_path / "run.checkpoint").write_text("something else")
    done = run("merge", BASEMENT, "--out", tmp_path / "run")
    assert done.code == 0
    assert "starting over:" in done.err
