"""Taking a result away: every format the page offers, by name, each with the function that writes it."""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZipFile

from slam.exports.formats import EXPORTS, export
from slam.exports.product import load_product
from slam.figures import gallery
from slam.html_report import page
from slam.result_folder import REPORT, story_of

Writer = Callable[[Path, Path], None]  # the result folder, and the file to write
STEMS = {"tum": "trajectory", "g2o": "graph"}  # of the formats that hold no map
OF_SEVERAL_FILES = {"pgm"}


@dataclass(frozen=True)
class Download:
    """file: its name for whoever takes it. says: what it is, for people. write: makes it from a result folder."""

    file: str
    says: str
    write: Writer


def fetch(result: Path, name: str, folder: Path) -> Iterator[Path]:
    """The task behind a click on a format: its file, freshly written into `folder`."""
    download = DOWNLOADS[name]
    download.write(result, folder / download.file)
    yield folder / download.file


def _exported(result: Path, to: Path) -> None:
    export(load_product(result), to)


def _exported_together(result: Path, to: Path) -> None:
    """A format of several files, in one archive named after it."""
    with TemporaryDirectory() as scratch:
        _packed(export(load_product(result), Path(scratch) / to.stem), to)


def _write_report(result: Path, to: Path) -> None:
    shutil.copyfile(result / REPORT, to)


def _write_page(result: Path, to: Path) -> None:
    with _with_figures(result) as whole:
        to.write_text(page(whole), encoding="utf-8")


def _write_figures(result: Path, to: Path) -> None:
    with _with_figures(result) as whole:
        _packed(sorted((whole / "figures").glob("*.png")), to)


@contextmanager
def _with_figures(result: Path) -> Iterator[Path]:
    """The result with its figures: as it is, or a copy where they are drawn now."""
    if (result / "figures").is_dir():
        yield result
        return
    with TemporaryDirectory() as scratch:
        whole = Path(shutil.copytree(result, Path(scratch) / "result"))
        gallery.draw(story_of(whole), whole / "figures")
        yield whole


def _packed(files: list[Path], to: Path) -> None:
    with ZipFile(to, "w") as archive:
        for path in files:
            archive.write(path, path.name)


def _offered() -> Iterator[tuple[str, Download]]:
    yield "page", Download("report.html", "one page with map, figures, scores and refusals", _write_page)
    for name, format_ in EXPORTS.items():
        file = f"{STEMS.get(name, 'map')}{format_.suffix}"
        if name in OF_SEVERAL_FILES:
            yield name, Download(f"{file}.zip", format_.says, _exported_together)
        else:
            yield name, Download(file, format_.says, _exported)
    yield "report", Download("report.json", "counts, timings, and everything that was refused", _write_report)
    yield "figures", Download("figures.zip", "the figures of the run as PNG", _write_figures)


DOWNLOADS: dict[str, Download] = dict(_offered())
