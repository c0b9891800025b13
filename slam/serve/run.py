"""A run as the page follows it: its messages in order, from the first, and a bell that rings for every new one."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import suppress
from enum import StrEnum
from pathlib import Path

from slam.serve.messages import kind_of, pack
from slam.serve.worker import Failures, Task, TaskError, Worker

SUPERSEDED = {"poses", "room"}  # only the newest of these says anything


class State(StrEnum):
    """How far a run is."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"


class Run:
    """One recording being merged, or one result being shown. result: the folder that merge wrote, or will have.

    source: where the files lie that it is made from. failures: what its task may raise for the page to tell.
    """

    def __init__(self, name: str, result: Path, source: Path, failures: Failures) -> None:
        self.name, self.result, self.source = name, result, source
        self.state = State.WAITING
        self._worker = Worker(failures)
        self._messages: list[bytes | None] = []
        self._newest: dict[str, int] = {}
        self._bell = asyncio.Event()
        self._life: asyncio.Task[None] | None = None

    @property
    def is_over(self) -> bool:
        """Whether nothing more will come."""
        return self.state in {State.DONE, State.FAILED}

    def start(self, turn: asyncio.Semaphore, seconds: float | None, task: Task, *arguments: object) -> None:
        """Begin as soon as it is this run's turn."""
        self._life = asyncio.create_task(self._live(turn, seconds, task, arguments))

    async def stop(self) -> None:
        """End it, wherever it is; what came out so far stays to be seen."""
        if self._life is not None:
            self._life.cancel()
            with suppress(asyncio.CancelledError):
                await self._life

    async def follow(self) -> AsyncIterator[bytes]:
        """Every message from the first to the last, waiting for those that are yet to come."""
        place = 0
        while True:
            bell = self._bell
            while place < len(self._messages):
                message = self._messages[place]
                place += 1
                if message is not None:
                    yield message
            if self.is_over:
                return
            await bell.wait()

    def add(self, message: bytes) -> None:
        """Keep a message for all who follow."""
        kind = kind_of(message)
        if kind in SUPERSEDED:
            if kind in self._newest:
                self._messages[self._newest[kind]] = None
            self._newest[kind] = len(self._messages)
        self._messages.append(message)
        self._ring()

    async def _live(
        self, turn: asyncio.Semaphore, seconds: float | None, task: Task, arguments: tuple[object, ...]
    ) -> None:
        try:
            async with turn:
                self.state = State.RUNNING
                await self._worker.run(seconds, self.add, task, *arguments)
            self._close(State.DONE, pack("done"))
        except TaskError as reason:
            self._close(State.FAILED, pack("failed", {"reason": self._told(str(reason))}))
        except asyncio.CancelledError:
            self._close(State.FAILED, pack("failed", {"reason": "stopped before it was done"}))
            raise
        finally:
            self._worker.end()

    def _told(self, reason: str) -> str:
        """The reason in the words of whoever gave the files: where we keep them is nobody's concern."""
        return reason.replace(f"{self.source}/", "").replace(str(self.source), self.name)

    def _close(self, state: State, message: bytes) -> None:
        self.add(message)
        self.state = state
        self._ring()

    def _ring(self) -> None:
        bell, self._bell = self._bell, asyncio.Event()
        bell.set()
