"""Workers: values come out in order, failures as sentences, and nothing outlives its time."""

import asyncio
import os
import time
from collections.abc import Iterator
from typing import Any

import pytest

from slam.readers.recording import RecordingError
from slam.serve.worker import TaskError, Worker


def count(most: int) -> Iterator[tuple[int, int]]:
    for number in range(most):
        yield number, os.getpid()


def foreseen() -> Iterator[int]:
    yield 1
    raise RecordingError("drive.log line 7:\n  too short")


def crash() -> Iterator[int]:
    yield 1
    os._exit(7)


def sleep(seconds: float) -> Iterator[int]:
    yield 1
    time.sleep(seconds)
    yield 2


async def _told(worker: Worker, seconds: float | None, *task: Any) -> tuple[list[Any], str | None]:
    values: list[Any] = []
    try:
        await worker.run(seconds, values.append, *task)
    except TaskError as reason:
        return values, str(reason)
    return values, None


def test_one_process_does_task_after_task_and_survives_what_was_foreseen() -> None:
    async def story() -> None:
        worker = Worker((RecordingError,))
        first, trouble = await _told(worker, 60, count, 3)
        assert [number for number, _ in first] == [0, 1, 2]
        assert trouble is None
        assert await _told(worker, 60, foreseen) == ([1], "drive.log line 7: too short")
        assert (await worker.ask(60, count, 1)) == first[0]
        assert first[0][1] != os.getpid()
        worker.end()

    asyncio.run(story())


def test_who_takes_too_long_or_crashes_is_ended_and_the_next_task_has_a_new_process() -> None:
    async def story() -> None:
        worker = Worker((RecordingError,))
        await worker.ask(60, count, 1)
        began = time.monotonic()
        values, trouble = await _told(worker, 0.5, sleep, 60)
        assert values == [1]
        assert trouble == "stopped, because it took longer than 0.5 seconds"
        assert time.monotonic() - began < 30
        values, trouble = await _told(worker, 60, crash)
        assert values == [1]
        assert trouble == "its process ended unexpectedly with exit code 7; the terminal says why"
        assert (await worker.ask(60, count, 1))[0] == 0
        worker.end()

    asyncio.run(story())


def test_a_task_that_is_called_off_ends_at_once() -> None:
    async def story() -> None:
        worker = Worker((RecordingError,))
        await worker.ask(60, count, 1)
        task = asyncio.create_task(_told(worker, 60, sleep, 60))
        await asyncio.sleep(0.3)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        assert (await worker.ask(60, count, 1))[0] == 0
        worker.end()

    asyncio.run(story())
