"""Bad input: one sentence on standard error with file, line and numbers, exit code 1, and no half-written output."""

import gzip
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.stories.command_line import run
from tests.stories.spoiled import BASEMENT, ROOM, flaser, log, one_sentence


def table(folder: Path, *rows: str) -> Path:
    path = folder / "hall.csv"
    path.write_text("time,x,y,heading,range@-90,range@0,range@90\n" + "".join(f"{row}\n" for row in rows))
    return path


def basement(folder: Path, change: Callable[[str], str], file: str = "readings.csv") -> Path:
    copy = folder / "basement"
    shutil.copytree(BASEMENT, copy)
    (copy / file).write_text(change((copy / file).read_text()))
    return copy


def without_last_range(text: str) -> str:
    lines = text.splitlines()
    return "\n".join([*lines[:-1], ",".join(lines[-1].split(",")[:-3])]) + "\n"


BAD_RECORDINGS: dict[str, tuple[Callable[[Path], Path], str]] = {
    "a missing file": (lambda f: f / "attic.log", "attic.log does not exist"),
    "an unknown kind of file": (lambda f: (f / "a.txt", (f / "a.txt").write_text("Dear John"))[0], "format unknown"),
    "an empty file": (lambda f: (f / "a.txt", (f / "a.txt").write_text(""))[0], "a.txt: the file is empty"),
    "an empty log": (log, "no line of FLASER or ROBOTLASER1"),
    "a truncated line": (lambda f: log(f, flaser(1), flaser(2)[:30]), "hall.log line 2: 4 ranges are announced"),
    "a garbled line": (lambda f: log(f, flaser(1), "\x00\x17#!\n"), "hall.log line 2: "),
    "a word among the ranges": (lambda f: log(f, flaser(1, "1 2 x 3")), "hall.log line 1: 'x' is not a number"),
    "NaN ranges": (lambda f: log(f, flaser(1, "1 2 nan 3")), "hall.log line 1: range 3 of 4 is NaN"),
    "negative ranges": (lambda f: log(f, flaser(1, "1 -2 3 4")), "hall.log line 1: range 2 of 4 is negative"),
    "ranges of zero only": (lambda f: log(f, flaser(1, "0 0 0 0")), "hall.log line 1: none of 4 ranges is usable"),
    "a scan without readings": (lambda f: log(f, "FLASER 0 0 0 0 1 0 0 1 nohost 1\n"), "hall.log line 1: "),
    "backward times": (lambda f: log(f, flaser(2), flaser(1)), "line 2: time 1.000000 does not come after 2.000000"),
    "a binary file": (lambda f: (log(f), (f / "hall.log").write_bytes(bytes(range(256)) * 9))[0], "no line of FLASER"),
    "no gzip at all": (lambda f: (f / "a.log.gz", (f / "a.log.gz").write_text("plain"))[0], "a.log.gz"),
    "a broken gzip": (
        lambda f: (f / "a.log.gz", (f / "a.log.gz").write_bytes(gzip.compress(flaser(1).encode())[:20]))[0],
        "a.log.gz",
    ),
    "fewer ranges than bearings": (lambda f: table(f, "1,0,0,0,1,2"), "hall.csv line 2: 2 ranges, but 3 bearings"),
    "a zero range": (lambda f: table(f, "1,0,0,0,1,0,3"), "hall.csv line 2: range 2 of 3 is zero"),
    "repeated times": (
        lambda f: table(f, "1,0,0,0,1,2,3", "1,0,0,0,1,2,3"),
        "hall.csv line 3: time 1.000000 does not come after 1.000000",
    ),
    "a table without scans": (table, "no scan in it"),
    "a column nobody knows": (
        lambda f: basement(f, lambda t: t.replace("range@0.0", "depth@0.0", 1)),
        "column 'depth@",
    ),
    "a short line in the basement": (lambda f: basement(f, without_last_range), "readings.csv line 4: "),
    "a recording.toml of text": (lambda f: basement(f, lambda _: "hello", "recording.toml"), "is not TOML"),
    "an unknown fact": (
        lambda f: basement(f, lambda t: t.replace("quantum", "kwantum"), "recording.toml"),
        "unknown key sensor.kwantum; known are half_beam_degrees",
    ),
    "readings that are not there": (
        lambda f: basement(f, lambda t: t.replace("readings.csv", "other.csv"), "recording.toml"),
        "other.csv cannot be read: No such file",
    ),
}


@pytest.mark.parametrize("kind", BAD_RECORDINGS)
def test_a_bad_recording_is_one_sentence_and_leaves_nothing_behind(tmp_path: Path, kind: str) -> None:
    make, says = BAD_RECORDINGS[kind]
    out = tmp_path / "out" / "run"
    told = run("merge", make(tmp_path), "--out", out)
    assert says in told.err
    assert one_sentence(told.err)
    assert told.code == 1
    assert not out.parent.exists()


def test_an_unknown_setting_is_named_with_the_known_ones(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text("[merging]\ncel = 0.05\n")
    told = run("merge", BASEMENT, "--out", tmp_path / "run", "--settings", tmp_path / "mine.toml")
    assert told.code == 1
    assert "mine.toml: unknown key merging.cel; known are cell, " in told.err
    assert one_sentence(told.err)
    assert not (tmp_path / "run").exists()


def test_a_folder_that_is_not_ours_is_refused_before_the_work(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    told = run("merge", BASEMENT, "--out", tmp_path)
    assert told.code == 1
    assert "choose another folder" in told.err
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--from", "-1,2", "--to", "3,3"], "start (-1, 2) lies 1 m outside of free space"),
        (["--from", "1,1", "--to", "9,3"], "goal (9, 3) lies 5 m outside of free space"),
        (["--from", "1,1,0", "--to", "0.05,3,0"], "goal (0.05, 3) at 0° overlaps an obstacle"),
        (["--from", "1", "--to", "3,3"], "'1' has 1 parts, but X,Y or X,Y,HEADING"),
        (["--from", "1,a", "--to", "3,3"], "'1,a' is no X,Y[,HEADING]"),
        (["--from", "1,1", "--to", "3,3", "--robot", "cube:3"], '"cube:3" names no robot'),
    ],
)
@pytest.mark.parametrize("planner", ["cones", "configuration-space"])
def test_a_bad_question_to_a_planner_is_one_sentence(
    tmp_path: Path, planner: str, arguments: list[str], says: str
) -> None:
    (tmp_path / "room.geojson").write_text(ROOM)
    robot = [] if "--robot" in arguments else ["--robot", "rectangle:0.4x0.3"]
    told = run("plan", tmp_path / "room.geojson", *arguments, *robot, "--planner", planner)
    assert says in told.err
    assert one_sentence(told.err)
    assert told.code == 1


@pytest.mark.parametrize(
    ("command", "says"),
    [
        (["score", "nowhere"], "nowhere is no result of merge: report.json no such file"),
        (["draw", "nowhere"], "nowhere is no result of merge"),
        (
            ["plan", ".", "--from", "0,0", "--to", "1,1", "--robot", "disc:1", "--planner", "cones"],
            ". is a folder: name",
        ),
        (["simulate", "nowhere.geojson", "--out", "folder"], "nowhere.geojson"),
        (
            ["plan", "nowhere.geojson", "--from", "0,0", "--to", "1,1", "--robot", "disc:1", "--planner", "cones"],
            "nowhere",
        ),
    ],
)
def test_a_missing_file_is_one_sentence_for_every_command(command: list[str], says: str) -> None:
    told = run(*command)
    assert says in told.err
    assert one_sentence(told.err)
    assert told.code == 1


def test_a_checkpoint_that_cannot_be_used_is_told_and_the_run_starts_over(tmp_path: Path) -> None:
    (tmp_path / "run.checkpoint").write_text("half a line")
    told = run("merge", BASEMENT, "--out", tmp_path / "run")
    assert told.code == 0
    assert re.match(r"starting over: \S*run\.checkpoint ", told.err)
    assert not (tmp_path / "run.checkpoint").exists()


def test_bad_usage_is_exit_code_2() -> None:
    assert run("merge").code == 2
    assert run("plan", "room.geojson").code == 2


def test_a_damaged_line_of_a_long_log_is_left_out_counted_and_told_unless_strict(tmp_path: Path) -> None:
    header = ",".join(["time,x,y,heading", *(f"range@{bearing}" for bearing in range(0, 360, 3))])
    ring = ",".join(f"{2 / max(abs(np.cos(a)), abs(np.sin(a))):.3f}" for a in np.radians(range(0, 360, 3)))
    rows = [header, *(f"{time},0,0,0,{ring}" for time in range(1, 31))]
    rows[21] = "21,0,0,0,1,2"
    path = tmp_path / "hall.csv"
    path.write_text("\n".join(rows))
    told = run("merge", path, "--out", tmp_path / "run")
    assert told.code == 0
    assert "hall.csv line 22: 2 ranges, but 120 bearings" in told.err
    assert '"damaged lines": 1' in (tmp_path / "run" / "report.json").read_text()
    told = run("merge", path, "--out", tmp_path / "strict", "--strict")
    assert told.code == 1
    assert told.err.startswith("roomsketch: hall.csv line 22: 2 ranges, but 120 bearings")
    assert not (tmp_path / "strict").exists()
