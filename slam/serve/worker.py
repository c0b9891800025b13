"""A worker: a process of its own that does one task after another, so that the server never waits for geometry.

A task is a generator function at the top of a module; what it yields comes out in order. Whatever is foreseen to fail
ends as one sentence; a task that takes too long is ended with its process, and the next one starts in a new process.
"""

import asyncio
import multiprocessing
import signal
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

Task = Callable[..., Iterator[Any]]
Failures = tuple[type[Exception], ...]
CONTEXT = multiprocessing.get_context("spawn")  # a fork would copy the server's threads and sockets half-alive
PATIENCE = 2.0  # seconds a process has to end by itself


class TaskError(Exception):
    """A task that ended without its result; the message is a sentence for the page."""


class Worker:
    """One process, started when first needed. failures: what a task may raise that is a sentence for the page."""

    def __init__(self, failures: Failures) -> None:
        self._failures = failures
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._turn = asyncio.Lock()

    async def run(self, seconds: float | None, receive: Callable[[Any], None], task: Task, *arguments: Any) -> None:
        """Do the task and hand whatever it yields to `receive`. Raises TaskError with the reason why it failed."""
        async with self._turn:
            pipe = self._connected()
            try:
                async with asyncio.timeout(seconds):
                    await asyncio.to_thread(pipe.send, (task, arguments))
                    while (said := await asyncio.to_thread(_received, pipe)) != ("done", None):
                        what, value = said
                        if what == "failed":
                            raise TaskError(value)
                        receive(value)
            except TimeoutError:
                self.end()
                raise TaskError(f"stopped, because it took longer than {seconds:g} seconds") from None
            except (EOFError, OSError):
                raise TaskError(f"its process ended unexpectedly{self._exit_code()}; the terminal says why") from None
            except asyncio.CancelledError:
                self.end()
                raise

    async def ask(self, seconds: float, task: Task, *arguments: Any) -> Any:
        """The one value that a task yields."""
        values: list[Any] = []
        await self.run(seconds, values.append, task, *arguments)
        return values[0]

    def end(self) -> None:
        """End the process at once."""
        process, self._process = self._process, None
        if process is not None:
            process.terminate()
            process.join(PATIENCE)
            if process.is_alive():
                process.kill()
                process.join(PATIENCE)
        if self._pipe is not None:
            self._pipe.close()
            self._pipe = None

    def _connected(self) -> Connection:
        if self._process is None or self._pipe is None or not self._process.is_alive():
            self.end()
            self._pipe, theirs = CONTEXT.Pipe()
            self._process = CONTEXT.Process(target=_work, args=(theirs, self._failures), daemon=True)
            self._process.start()
            theirs.close()
        return self._pipe

    def _exit_code(self) -> str:
        process = self._process
        if process is None:
            return ""
        process.join(PATIENCE)
        return f" with exit code {process.exitcode}"


def _received(pipe: Connection) -> tuple[str, Any]:
    """The next of what the process says; EOFError when it is gone."""
    said: tuple[str, Any] = pipe.recv()
    return said


def _work(pipe: Connection, failures: Failures) -> None:
    """The life of the process: tasks come in, what they yield goes out, until the other end is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to the whole group; the server ends its workers itself
    while True:
        try:
            task, arguments = pipe.recv()
        except EOFError:
            return
        try:
            for value in task(*arguments):
                pipe.send(("value", value))
        except failures as failure:
            pipe.send(("failed", " ".join(str(failure).split())))
        except BrokenPipeError:
            return
        else:
            pipe.send(("done", None))
