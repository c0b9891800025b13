"""Taking a result away: every format the page offers, by name, each with the function that writes it."""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZIP_STORED, ZipFile

from slam import figures
from slam.result_folder import MAP, REPORT, TRAJECTORY, story_of

Writer = Callable[[Path, Path], None]  # the result folder, and the file to write


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


def _copied(name: str) -> Writer:
    def write(result: Path, to: Path) -> None:
        shutil.copyfile(result / name, to)

    return write


def _write_figures(result: Path, to: Path) -> None:
    """The figures of the run, drawn if nobody did so yet, in one archive."""
    with TemporaryDirectory() as scratch:
        drawn = result / "figures"
        if not drawn.is_dir():
            drawn = Path(scratch)
            figures.draw(story_of(result), drawn)
        with ZipFile(to, "w", ZIP_STORED) as archive:
            for picture in sorted(drawn.glob("*.png")):
                archive.write(picture, picture.name)


DOWNLOADS: dict[str, Download] = {
    "geojson": Download("map.geojson", "the map with the provenance of every edge", _copied(MAP)),
    "tum": Download("trajectory.tum", "the trajectory, one pose a scan", _copied(TRAJECTORY)),
    "report": Download("report.json", "counts, timings, and everything that was refused", _copied(REPORT)),
    "figures": Download("figures.zip", "the six figures of the run as PNG", _write_figures),
}
