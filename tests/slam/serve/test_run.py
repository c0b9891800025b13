"""Runs: whoever comes late hears the same story, without what is superseded."""

import asyncio
from collections.abc import Iterator
from pathlib import Path

from slam.readers.recording import RecordingError
from slam.serve.messages import pack, unpack
from slam.serve.run import Run, State

SOURCE = Path("/somewhere/files")


def tell() -> Iterator[bytes]:
    for views in (1, 2):
        yield pack("scan", {"index": views})
        yield pack("room", {"views": views})


def fail() -> Iterator[bytes]:
    yield pack("opening")
    raise RecordingError(f"{SOURCE}/drive.csv: no scan in it")


async def heard(run: Run) -> list[tuple[str, object]]:
    heads = [unpack(message)[0] for message in [message async for message in run.follow()]]
    return [(head.pop("kind"), head) for head in heads]


def test_early_and_late_followers_hear_the_run_to_its_end() -> None:
    async def story() -> None:
        run = Run("drive.csv", Path("result"), SOURCE, (RecordingError,))
        run.start(asyncio.Semaphore(1), 60, tell)
        early = await heard(run)
        late = await heard(run)
        assert [kind for kind, _ in early] == ["scan", "room", "scan", "room", "done"]
        assert late == [("scan", {"index": 1}), ("scan", {"index": 2}), ("room", {"views": 2}), ("done", {})]
        assert run.state is State.DONE

    asyncio.run(story())


def test_a_failure_is_told_in_the_words_of_who_gave_the_file() -> None:
    async def story() -> None:
        run = Run("drive.csv", Path("result"), SOURCE, (RecordingError,))
        run.start(asyncio.Semaphore(1), 60, fail)
        assert (await heard(run))[-1] == ("failed", {"reason": "drive.csv: no scan in it"})
        assert run.state is State.FAILED

    asyncio.run(story())


def test_a_run_that_waits_for_its_turn_can_be_stopped() -> None:
    async def story() -> None:
        run = Run("drive.csv", Path("result"), SOURCE, (RecordingError,))
        run.start(asyncio.Semaphore(0), 60, tell)
        await asyncio.sleep(0)
        assert run.state is State.WAITING
        await run.stop()
        assert (await heard(run))[-1] == ("failed", {"reason": "stopped before it was done"})

    asyncio.run(story())
