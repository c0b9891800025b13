"""The documentation keeps its word: its files are written, its commands are run, and it builds without a warning."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import pytest

from slam.settings import Settings
from tests.stories.command_line import run

ROOT = Path.cwd()
PAGES = ROOT / "docs" / "pages"
BLOCK = re.compile(r"^```(?P<language>\w+)(?: title=\"(?P<title>[^\"]+)\")?\n(?P<content>.*?)^```$", re.M | re.S)
WITH_COMMANDS = [page.name for page in sorted(PAGES.glob("*.md")) if "```sh\n" in page.read_text()]
PACKAGES = ("slam", "frontend", "backend", "planners")


def _follow(page: Path) -> list[str]:
    """Do what a page says, block by block, here; the commands that were run."""
    done = []
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        if block["title"]:
            Path(block["title"]).write_text(block["content"], encoding="utf-8")
        for line in block["content"].splitlines() if block["language"] == "sh" else ():
            program, *arguments = shlex.split(line, comments=True)
            if program == "python":
                environment = os.environ | {"PYTHONPATH": str(ROOT)}
                subprocess.run([sys.executable, *arguments], check=True, capture_output=True, env=environment)
            else:
                assert program == "roomsketch"
                told = run(*arguments)
                assert told.code == 0, told.err
            done.append(line)
    return done


@pytest.mark.parametrize("name", WITH_COMMANDS)
def test_every_command_of_a_page_runs(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "datasets").symlink_to(ROOT / "datasets")
    monkeypatch.chdir(tmp_path)
    assert _follow(PAGES / name)


def settings_tables(table: Any, path: str = "") -> Iterator[str]:
    """What the page of settings says of every table of settings, in their order."""
    for field in fields(table):
        branch = getattr(table, field.name)
        if is_dataclass(branch):
            inside = f"{path}.{field.name}".lstrip(".")
            yield f"### `[{inside}]`\n\n::: {type(branch).__module__}.{type(branch).__name__}\n"
            yield from settings_tables(branch, inside)


def test_every_table_of_settings_has_its_place_on_their_page() -> None:
    page = (PAGES / "settings.md").read_text(encoding="utf-8")
    assert [told for told in settings_tables(Settings()) if told not in page] == []


def test_the_site_builds_without_a_warning(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "docs", tmp_path / "docs", ignore=shutil.ignore_patterns("figures"))
    for package in PACKAGES:
        (tmp_path / package).symlink_to(ROOT / package)
    figures = tmp_path / "docs" / "pages" / "figures"
    figures.mkdir()
    for shown in re.findall(r"figures/(\S+?\.png)", "\n".join(page.read_text() for page in PAGES.glob("*.md"))):
        (figures / shown).write_bytes(b"")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--config-file", "docs/mkdocs.yml"]
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1"}
    told = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    assert "WARNING" not in told.stderr


def test_the_figures_that_are_shown_are_those_that_merge_draws(tmp_path: Path) -> None:
    assert run("merge", "datasets/flynn_basement", "--out", tmp_path / "run").code == 0
    drawn = {picture.name for picture in (tmp_path / "run" / "figures").iterdir()}
    shown = set(re.findall(r"\(figures/(\S+?\.png)\)", "\n".join(page.read_text() for page in PAGES.glob("*.md"))))
    assert shown <= drawn
