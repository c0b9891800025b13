"""Checkpoints: a run that was killed goes on to the same bytes; a checkpoint of something else is told apart."""

import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from backend.estimate import Estimate
from frontend.scan import Scan
from slam.checkpoint import FORMAT, CheckpointError, Keeper, resumed
from slam.logbook import Logbook
from slam.mapper import Mapper
from slam.readers.recording import Recording
from slam.recordings import open_recording
from slam.settings import Settings
from tests.simulated_drives import drive, once_round, round_building

ROOT = Path(__file__).parents[2]
SETTINGS = Settings()
KILLED = """
import os, signal, sys
from pathlib import Path
from slam.checkpoint import Keeper
from slam.logbook import Logbook
from slam.pipeline import merge_scans
from slam.readers.recording import Recording
from slam.recordings import open_recording
from slam.settings import Settings

def until_killed(scans):
    for number, scan in enumerate(scans):
        if number == 27:
            os.kill(os.getpid(), signal.SIGKILL)
        yield scan

keeper = Keeper(Path(sys.argv[1]), 10, Settings(), Logbook())
merge_scans(until_killed(open_recording(Path("datasets/apartment_lidar")).scans), Settings(), keeper)
"""


@pytest.fixture(scope="module")
def scans() -> list[Scan]:
    return drive(round_building(), once_round(step=0.6), seed=6)


def run(scans: list[Scan] | tuple[Scan, ...], keeper: Keeper) -> Mapper:
    mapper = Mapper(SETTINGS.frontend, SETTINGS.poses, keeper.logbook)
    for scan in scans:
        mapper.add(scan)
        keeper.passed(scan)
    return mapper


def recorded(scans: list[Scan], starts: tuple[int, ...] = ()) -> Recording:
    return Recording("round", tuple(scans), starts=starts)


def fresh(path: Path, every: int = 10) -> Keeper:
    return Keeper(path, every, SETTINGS, Logbook())


def same(first: Estimate, second: Estimate) -> bool:
    names = ("poses", "covariances", "landmarks", "keyframes")
    arrays = all(getattr(first, name).tobytes() == getattr(second, name).tobytes() for name in names)
    return arrays and first.decisions == second.decisions and first.calibration == second.calibration


def test_a_run_killed_without_warning_goes_on_to_the_same_bytes(tmp_path: Path) -> None:
    path = tmp_path / "run.checkpoint"
    killed = subprocess.run([sys.executable, "-c", KILLED, str(path)], cwd=ROOT, check=False)
    assert killed.returncode == -signal.SIGKILL
    recording = open_recording(ROOT / "datasets" / "apartment_lidar")
    scans, keeper = recording.scans, resumed(path, 10, recording, SETTINGS)
    assert keeper.known == 20
    whole = run(scans, fresh(tmp_path / "other.checkpoint")).result()
    assert same(run(scans, keeper).result(), whole)


@pytest.mark.parametrize("stopped", [1, 13, 40])
def test_wherever_a_run_stops_it_goes_on_to_the_same_bytes(scans: list[Scan], tmp_path: Path, stopped: int) -> None:
    path = tmp_path / "run.checkpoint"
    first = fresh(path, every=1000)
    run(scans[:stopped], first)
    first.write()
    second = resumed(path, 1000, recorded(scans), SETTINGS)
    questions = len(second.logbook.lines)
    whole = run(scans, fresh(tmp_path / "other"))
    assert same(run(scans, second).result(), whole.result())
    assert len(whole.logbook.lines) - questions == len(second.logbook.lines) - questions > 0


def test_a_whole_file_is_there_from_every_tenth_scan_on(scans: list[Scan], tmp_path: Path) -> None:
    keeper = fresh(tmp_path / "run.checkpoint")
    mapper = Mapper(SETTINGS.frontend, SETTINGS.poses, keeper.logbook)
    for number, scan in enumerate(scans[:25], start=1):
        mapper.add(scan)
        keeper.passed(scan)
        known = resumed(keeper.path, 10, recorded(scans), SETTINGS).known if number >= 10 else 0
        assert known == number // 10 * 10
        assert [path.name for path in tmp_path.iterdir()] == ["run.checkpoint"] * (number >= 10)


def test_an_interruption_inside_a_scan_is_kept_up_to_the_scan_before(scans: list[Scan], tmp_path: Path) -> None:
    keeper = fresh(tmp_path / "run.checkpoint")
    run(scans[:13], keeper)
    keeper.logbook.answer(lambda: "an answer of scan 13, which never ended")
    keeper.write()
    again = resumed(keeper.path, 10, recorded(scans), SETTINGS)
    assert again.known == 13
    assert len(again.logbook.lines) == len(keeper.logbook.lines) - 1


def test_a_run_that_is_stopped_while_it_catches_up_keeps_the_better_checkpoint(
    scans: list[Scan], tmp_path: Path
) -> None:
    keeper = fresh(tmp_path / "run.checkpoint")
    run(scans[:20], keeper)
    again = resumed(keeper.path, 10, recorded(scans), SETTINGS)
    run(scans[:12], again)
    again.write()
    assert resumed(keeper.path, 10, recorded(scans), SETTINGS).known == 20


def moved(scan: Scan) -> Scan:
    return replace(scan, odometry=scan.odometry + np.array([0, 0, 1e-12]))


OTHER_SETTINGS = replace(SETTINGS, poses=replace(SETTINGS.poses, keyframe_metres=0.2))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda drive: (drive, OTHER_SETTINGS), "other settings"),
        (
            lambda drive: (recorded([*drive.scans[:4], moved(drive.scans[4]), *drive.scans[5:]]), SETTINGS),
            "another rec",
        ),
        (lambda drive: (recorded(drive.scans[:9]), SETTINGS), "another recording"),
        (lambda drive: (recorded(drive.scans, starts=(5,)), SETTINGS), "another recording"),
    ],
)
def test_a_checkpoint_of_another_run_is_refused_with_the_reason(
    scans: list[Scan], tmp_path: Path, change: Callable[[Recording], tuple[Recording, Settings]], says: str
) -> None:
    path = tmp_path / "run.checkpoint"
    run(scans[:10], fresh(path))
    with pytest.raises(CheckpointError, match=says):
        resumed(path, 10, *change(recorded(scans)))


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        (lambda text: "", "no checkpoint"),
        (lambda text: "hello\n" + text, "no checkpoint"),
        (lambda text: text[: len(text) // 2], "damaged"),
        (lambda text: text.replace(f'"format": {FORMAT}', '"format": 99'), "format 99"),
        (lambda text: text.replace('"version": "', '"version": "9.'), "version 9."),
    ],
)
def test_a_damaged_or_foreign_file_is_refused_with_the_reason(
    scans: list[Scan], tmp_path: Path, damage: Callable[[str], str], says: str
) -> None:
    path = tmp_path / "run.checkpoint"
    run(scans[:10], fresh(path))
    path.write_text(damage(path.read_text()))
    with pytest.raises(CheckpointError, match=says):
        resumed(path, 10, recorded(scans), SETTINGS)
