"""The gallery: all runs of one server by number, the places of their files, and the desk that answers questions."""

import asyncio
import shutil
from dataclasses import dataclass
from pathlib import Path

from slam.failures import all_failures
from slam.result_folder import Source
from slam.serve.growth import Errand, grow
from slam.serve.replay import replay
from slam.serve.run import Run
from slam.serve.truth import Truth
from slam.serve.uploads import Limits, merge_upload
from slam.serve.worker import Worker

FAILURES = all_failures()
MOST_KEPT = 8  # runs; with one more, the oldest upload is forgotten
AT_ONCE = 1  # merges; the others wait for their turn


@dataclass(frozen=True)
class Shown:
    """What the command line asked for: a recording to merge, or the folder of a result."""

    source: Source
    is_result: bool
    truth: Truth


class Gallery:
    """Runs come, wait for their turn, and go. scratch: the one folder everything is written into."""

    def __init__(self, scratch: Path, limits: Limits | None = None) -> None:
        self.scratch, self.limits = scratch, limits or Limits()
        self.runs: dict[int, Run] = {}
        self.desk = Worker(FAILURES)
        self._turn = asyncio.Semaphore(AT_ONCE)
        self._given = 0

    def new_place(self) -> tuple[int, Path]:
        """The number of a run to come, and an empty folder for its files."""
        self._given += 1
        folder = self.scratch / f"run-{self._given}" / "files"
        folder.mkdir(parents=True)
        return self._given, folder

    def show(self, shown: Shown) -> Run:
        """Begin with what the command line asked for; nothing of its cost is bounded: it is the user's own."""
        number, folder = self.new_place()
        path = shown.source.path
        if shown.is_result:
            run = self._keep(number, Run(path.resolve().name, path, path, FAILURES))
            run.start(self._turn, None, replay, path, shown.truth)
        else:
            run = self._keep(number, Run(path.resolve().name, folder.parent / "result", path, FAILURES))
            run.start(self._turn, None, grow, Errand(shown.source, run.result, shown.truth))
        return run

    def merge_stranger(self, number: int, source: Source) -> Run:
        """Merge what was dropped on the page, within the limits."""
        folder = source.path if source.path.is_dir() else source.path.parent
        name = "dropped recording" if source.path.is_dir() else source.path.name
        run = self._keep(number, Run(name, folder.parent / "result", folder, FAILURES))
        errand = Errand(source, run.result, Truth.beside(folder))
        run.start(self._turn, self.limits.seconds_merging, merge_upload, errand, self.limits)
        return run

    async def close(self) -> None:
        """Stop everything."""
        self.desk.end()
        for run in self.runs.values():
            await run.stop()

    def _keep(self, number: int, run: Run) -> Run:
        self.runs[number] = run
        over = [old for old, kept in self.runs.items() if kept.is_over and old > 1]
        if len(self.runs) > MOST_KEPT and over:
            del self.runs[over[0]]
            shutil.rmtree(self.scratch / f"run-{over[0]}", ignore_errors=True)
        return run
