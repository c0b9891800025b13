"""Output appears whole or not at all, and never at the cost of files that are not ours."""

from errno import ENOSPC
from pathlib import Path

import pytest

from slam.whole_output import RESULT_MARK, OutputError, whole_folder, write_whole


def interrupted(folder: Path) -> None:
    with whole_folder(folder) as hidden:
        (hidden / RESULT_MARK).write_text("half")
        raise KeyboardInterrupt


def test_an_interrupted_run_leaves_the_earlier_result_and_nothing_else(tmp_path: Path) -> None:
    with whole_folder(tmp_path / "run") as folder:
        (folder / RESULT_MARK).write_text("first")
    with pytest.raises(KeyboardInterrupt):
        interrupted(tmp_path / "run")
    assert (tmp_path / "run" / RESULT_MARK).read_text() == "first"
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_an_earlier_result_gives_way_as_a_whole(tmp_path: Path) -> None:
    for name in (RESULT_MARK, "old.png"):
        write_whole(tmp_path / "run" / name, "old")
    with whole_folder(tmp_path / "run") as folder:
        (folder / RESULT_MARK).write_text("new")
    assert [path.name for path in (tmp_path / "run").iterdir()] == [RESULT_MARK]


def a_page_in_vain(wanted: Path) -> None:
    with whole_folder(wanted) as hidden:
        (hidden / "report.html").mkdir()
        write_whole(hidden / "report.html", "")


def test_a_full_disk_is_one_sentence_with_the_name_that_was_asked_for(tmp_path: Path) -> None:
    wanted = tmp_path / "run"
    with pytest.raises(OutputError, match=r"run cannot be written: No space left") as told, whole_folder(wanted):
        raise OSError(ENOSPC, "No space left on device")
    assert str(told.value).startswith(f"{wanted} cannot")
    with pytest.raises(OutputError) as told:
        a_page_in_vain(wanted)
    assert str(told.value).startswith(f"{wanted / 'report.html'} cannot be written: ")
    assert not list(tmp_path.iterdir())


def test_a_folder_with_other_files_is_not_touched(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(OutputError, match="holds other files"), whole_folder(tmp_path):
        pass
    assert (tmp_path / "thesis.tex").exists()


def test_a_file_in_the_way_is_said(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("")
    with pytest.raises(OutputError, match="is a file"), whole_folder(tmp_path / "run"):
        pass
    with pytest.raises(OutputError, match="cannot be written"):
        write_whole(tmp_path / "run" / "map.geojson", "")
