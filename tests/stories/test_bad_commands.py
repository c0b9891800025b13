"""Every command, asked for what cannot be: one sentence on standard error, exit code 1, and nothing is made."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.stories.command_line import run
from tests.stories.spoiled import BASEMENT, ROOM, flaser, log, one_sentence


def drawing(folder: Path, text: str) -> Path:
    path = folder / "fp.json"
    path.write_text(text)
    return path


def result(folder: Path, report: str) -> Path:
    (folder / "run").mkdir()
    (folder / "run" / "report.json").write_text(report)
    return folder / "run"


def room(folder: Path) -> Path:
    path = folder / "map.geojson"
    path.write_text(ROOM)
    return path


def bag(folder: Path) -> Path:
    path = folder / "drive.bag"
    path.write_bytes(b"#ROSBAG V2.0\n" + bytes(range(256)))
    return path


def settings(folder: Path, text: str) -> list[object]:
    path = folder / "mine.toml"
    path.write_text(text)
    return ["merge", BASEMENT, "--out", folder / "out", "--settings", path]


BAD_COMMANDS: dict[str, tuple[Callable[[Path], list[object]], str]] = {
    "convert nothing": (lambda f: ["convert", f / "attic.log", f / "out"], "attic.log does not exist"),
    "convert a recording to a map": (
        lambda f: ["convert", BASEMENT, f / "out.svg"],
        "is a recording, and has no map to export yet; first `roomsketch merge ",
    ),
    "convert to an unknown format": (
        lambda f: ["convert", room(f), f / "out.png"],
        "out.png: no format to export ends in '.png'; known are .geojson, .rectangles.geojson, .svg",
    ),
    "convert to no format": (lambda f: ["convert", room(f), f / "out"], "out: no format to export ends in nothing"),
    "convert a map to a trajectory": (
        lambda f: ["convert", room(f), f / "out.tum"],
        "map.geojson holds no trajectory: export from the folder that merge wrote",
    ),
    "convert a broken bag": (lambda f: ["convert", bag(f), f / "out"], "drive.bag cannot be read as a bag after 0 "),
    "convert under a wrong name": (
        lambda f: ["convert", BASEMENT, f / "out", "--format", "rosbag"],
        "unknown format 'rosbag'; known are recording, carmen",
    ),
    "convert over other files": (
        lambda f: ["convert", BASEMENT, room(f).parent],
        "holds other files and no recording.toml of an earlier run: choose another folder",
    ),
    "view nothing": (lambda f: ["view", f / "attic", "--no-browser"], "attic does not exist: name a folder that merge"),
    "view what is no recording": (
        lambda f: ["view", room(f).parent, "--no-browser"],
        "holds none of recording.toml, *_motors.txt, metadata.yaml, only map.geojson",
    ),
    "view a broken report": (lambda f: ["view", result(f, "{"), "--no-browser"], "report.json is not JSON: "),
    "view a foreign report": (lambda f: ["view", result(f, "{}"), "--no-browser"], "it names no recording"),
    "view where nobody can": (
        lambda _: ["view", "--host", "300.1.1.1", "--no-browser"],
        "port 8765 on 300.1.1.1 cannot be opened",
    ),
    "a plan of nothing": (lambda f: ["floor-plan", f / "fp.json", 1, "--out", f / "out"], "fp.json cannot be read"),
    "a plan of a list": (
        lambda f: ["floor-plan", drawing(f, "[]"), 1, "--out", f / "out"],
        "fp.json is no fp.json of MLSTRUCT-FP, which holds shapes",
    ),
    "a plan without walls": (
        lambda f: ["floor-plan", drawing(f, "{}"), 1, "--out", f / "out"],
        "has no rect on floor 1, and no rect at all",
    ),
    "a plan of another floor": (
        lambda f: [
            "floor-plan",
            drawing(f, '{"rect": {"1": {"x": [0, 1, 1], "y": [0, 0, 1], "floorID": 7}}}'),
            1,
            "--out",
            f / "out",
        ],
        "has no rect on floor 1, known floors are 7",
    ),
    "one bad drive of two": (
        lambda f: ["merge", BASEMENT, log(f, flaser(2), flaser(1)), "--out", f / "out"],
        "hall.log line 2: time 1.000000 does not come after 2.000000",
    ),
    "one missing drive of two": (
        lambda f: ["merge", BASEMENT, f / "attic.log", "--out", f / "out"],
        "attic.log does not exist",
    ),
    "no settings": (
        lambda f: ["merge", BASEMENT, "--out", f / "out", "--settings", f / "mine.toml"],
        "mine.toml cannot be read: No such file",
    ),
    "settings of text": (lambda f: settings(f, "hello"), "mine.toml is not TOML: "),
    "a setting of the wrong type": (
        lambda f: settings(f, '[merging]\ncell = "fine"\n'),
        "mine.toml: merging.cell = 'fine' should be a number",
    ),
}


@pytest.mark.parametrize("kind", BAD_COMMANDS)
def test_every_command_says_in_one_sentence_what_is_wrong_and_makes_nothing(tmp_path: Path, kind: str) -> None:
    make, says = BAD_COMMANDS[kind]
    told = run(*make(tmp_path))
    assert says in told.err
    assert one_sentence(told.err)
    assert told.code == 1
    assert not list(tmp_path.glob("out*"))
