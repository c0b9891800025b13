"""Checkpoints: a run's logbook in a file, from which a killed run goes on to the very same result.

The file is text: a line of facts (JSON), then the lines of the logbook. It is written whole or not at all, and believed
only if it belongs to the same scans, settings and version.
"""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path

from frontend.scan import Scan
from slam import toml_file
from slam.logbook import Logbook
from slam.readers.recording import Recording
from slam.settings import Settings
from slam.whole_output import write_whole

FORMAT = 2


class CheckpointError(Exception):
    """A checkpoint that this run cannot go on from; the message says why."""


@dataclass(frozen=True)
class Facts:
    """What a checkpoint belongs to: file format, program version, settings, scans taken in and their fingerprint.

    answers: fingerprint of the logbook's lines.
    """

    format: int
    version: str
    settings: str
    scans: int
    fingerprint: str
    answers: str


class Keeper:
    """Writes the logbook of a run to `path` every so many scans; `known` scans were in the file it was read from."""

    def __init__(self, path: Path, every: int, settings: Settings, logbook: Logbook, known: int = 0) -> None:
        self.path, self.every, self.known, self.logbook = path, every, known, logbook
        self.scans = 0
        self._settings = toml_file.dumps(settings)
        self._fingerprint = hashlib.sha256()
        self._lines = 0  # of the logbook that belong to whole scans

    def passed(self, scan: Scan, starts: bool = False) -> None:
        """The mapper has taken in the next scan, which may start another drive."""
        _add_print(self._fingerprint, scan, starts)
        self.scans, self._lines = self.scans + 1, len(self.logbook.lines)
        if self.scans > self.known and self.scans % self.every == 0:
            self.write()

    def write(self) -> None:
        """Put down what is known up to the last whole scan. Raises OutputError."""
        if self.scans <= self.known:
            return
        lines = self.logbook.lines[: self._lines]
        facts = Facts(
            FORMAT,
            version("roomsketch"),
            self._settings,
            self.scans,
            self._fingerprint.hexdigest(),
            _fingerprint_of(lines),
        )
        write_whole(self.path, "\n".join([json.dumps(asdict(facts)), *lines]) + "\n")


def resumed(path: Path, every: int, recording: Recording, settings: Settings) -> Keeper:
    """A keeper that goes on from the file at `path`. Raises CheckpointError where that is of another run or damaged."""
    facts, lines = _read(path)
    differs = {
        f"was written by version {facts.version}": facts.version != version("roomsketch"),
        "is of a run with other settings": facts.settings != toml_file.dumps(settings),
        "is of another recording": facts.fingerprint != _print_of(recording, facts.scans),
    }
    for reason, holds in differs.items():
        if holds:
            raise CheckpointError(f"{path} {reason}")
    return Keeper(path, every, settings, Logbook(lines), facts.scans)


def _read(path: Path) -> tuple[Facts, list[str]]:
    try:
        first, *lines = path.read_text(encoding="utf-8").splitlines()
        facts = Facts(**json.loads(first))
    except OSError as reason:
        raise CheckpointError(f"{path} cannot be read: {reason.strerror or reason}") from reason
    except (ValueError, TypeError) as damage:
        raise CheckpointError(f"{path} is no checkpoint of this version") from damage
    if facts.format != FORMAT:
        raise CheckpointError(f"{path} has format {facts.format}, but this version reads format {FORMAT}")
    if facts.answers != _fingerprint_of(lines):
        raise CheckpointError(f"{path} is damaged: its {len(lines)} answers are not those that were written")
    return facts, lines


def _fingerprint_of(lines: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _print_of(recording: Recording, scans: int) -> str:
    fingerprint = hashlib.sha256()
    for number, scan in enumerate(recording.scans[:scans]):
        _add_print(fingerprint, scan, number in recording.starts)
    return fingerprint.hexdigest()


def _add_print(fingerprint: "hashlib._Hash", scan: Scan, starts: bool) -> None:
    """Every value of the scan goes into the fingerprint, with the sizes of its arrays."""
    facts = (starts, scan.sensor, scan.time, scan.ranges.size, scan.infrared is None)
    fingerprint.update(repr(facts).encode())
    for values in (scan.bearings, scan.ranges, scan.odometry):
        fingerprint.update(values.tobytes())
    if scan.infrared is not None:
        fingerprint.update(scan.infrared.tobytes())
