import subprocess
import sys
from errno import EACCES
from importlib.metadata import version
from pathlib import Path
from unittest.mock import Mock

import pytest

from slam.cli import COMMANDS
from tests.stories.command_line import run

HELP = """
import sys
from slam.cli import main
sys.argv = ["roomsketch", "--help"]
try:
    main()
finally:
    print(sorted({"gtsam", "numba", "matplotlib", "scipy"} & set(sys.modules)))
"""


def test_asking_for_help_loads_no_stage() -> None:
    told = subprocess.run([sys.executable, "-c", HELP], capture_output=True, text=True, check=True)
    assert told.stdout.splitlines()[-1] == "[]"


def test_every_command_is_listed_and_helps() -> None:
    listed = run("--help").out
    for command in COMMANDS:
        name = command.replace("_", "-")
        assert name in listed
        assert f"roomsketch {name}" in run(name, "--help").out


def test_a_place_where_one_may_not_look_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    barred = PermissionError(EACCES, "Permission denied", "secret/drive.log")
    monkeypatch.setattr(Path, "exists", Mock(side_effect=barred))
    told = run("view", "secret/drive.log")
    assert (told.code, told.err) == (1, "roomsketch: secret/drive.log: Permission denied\n")


def test_the_version_is_that_of_the_package() -> None:
    assert run("--version").out == f"roomsketch {version('roomsketch')}\n"


def test_an_unknown_command_is_bad_usage() -> None:
    told = run("mrge")
    assert told.code == 2
    assert "No such command 'mrge'" in told.err


def test_who_stops_it_while_it_loads_reads_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("slam.cli.import_module", Mock(side_effect=KeyboardInterrupt))
    told = run("merge", "drive.log")
    assert (told.code, told.err) == (130, "roomsketch: stopped before it began\n")
