"""Recordings dropped on the page: bounded in number, size and time, and kept in a folder of their own.

The request only stores bytes. What they mean is found out later, by a worker that is ended when it takes too long.
"""

import asyncio
import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException
from starlette.formparsers import MultiPartException
from starlette.requests import ClientDisconnect, Request
from starlette.types import Message, Receive

from slam.readers.recording import RecordingError
from slam.result_folder import Source
from slam.serve.growth import Errand, grow

MEGABYTE = 1 << 20
BLOCK = 64 << 10
ENDINGS = (".log", ".csv", ".txt", ".toml", ".geojson", ".tum", ".bag", ".mcap", ".db3", ".g2o")  # or those with .gz
LONGEST_NAME = 100


@dataclass(frozen=True)
class Limits:
    """What a stranger's file may cost."""

    files: int = 16  # of one recording; larger lets folders with more parts in
    megabytes: int = 64  # as sent; larger lets longer recordings in
    megabytes_unpacked: int = 256  # of .gz files; larger lets better packed recordings in, and worse bombs
    seconds_sending: float = 300.0  # larger bears slower senders
    seconds_merging: float = 900.0  # larger lets longer recordings finish
    seconds_planning: float = 60.0  # for one answer, or one file to take away


async def receive_upload(request: Request, folder: Path, limits: Limits) -> Source:
    """Store the files of a form in `folder`; what to open there. Raises HTTPException with a sentence."""
    bounded = Request(request.scope, _bounded(request, limits.megabytes * MEGABYTE))
    try:
        async with asyncio.timeout(limits.seconds_sending):
            async with bounded.form(max_files=limits.files, max_fields=0) as form:
                files = [part for part in form.getlist("files") if isinstance(part, UploadFile)]
                return await _store(files, folder)
    except TimeoutError:
        raise HTTPException(408, f"sending took longer than {limits.seconds_sending:g} seconds") from None
    except MultiPartException as reason:
        raise HTTPException(400, f"not a form with files: {reason.message}") from reason
    except ClientDisconnect as reason:
        raise HTTPException(400, "the sender hung up") from reason


def merge_upload(errand: Errand, limits: Limits) -> Iterator[bytes]:
    """The task behind an upload: grow a map of it, once it is known not to unpack without end."""
    source = errand.source.path
    check_unpacked([source] if source.is_file() else sorted(source.iterdir()), limits.megabytes_unpacked)
    return grow(errand)


def check_unpacked(files: list[Path], megabytes: int) -> None:
    """Raise RecordingError where packed files hold more than that in all; nothing is kept while looking."""
    left = megabytes * MEGABYTE
    for path in files:
        if path.suffix == ".gz":
            left -= _unpacked_size(path, left)
            if left < 0:
                raise RecordingError(f"{path.name} unpacks to more than the {megabytes} MB that are allowed")


def safe_name(name: str) -> str:
    """What a file may be called in its folder: its last part, in letters, digits, points, dashes and lines below."""
    last = re.split(r"[\\/]", name)[-1]
    return re.sub(r"[^A-Za-z0-9._-]", "_", last).lstrip(".")[-LONGEST_NAME:]


async def _store(files: list[UploadFile], folder: Path) -> Source:
    if not files:
        raise HTTPException(400, "no file was sent: drop a log, a CSV of ranges or the files of a recording folder")
    names = [safe_name(file.filename or "") for file in files]
    _check_names(names)
    for file, name in zip(files, names, strict=True):
        with (folder / name).open("xb") as stored:
            while block := await file.read(BLOCK):
                stored.write(block)
    return Source(folder / names[0] if len(names) == 1 else folder, None)


def _check_names(names: list[str]) -> None:
    for name in names:
        if not name.removesuffix(".gz").endswith(ENDINGS):
            known = ", ".join(ENDINGS)
            raise HTTPException(415, f"{name or 'a file without a name'} is no recording: known endings are {known}")
    if len(set(names)) < len(names):
        raise HTTPException(400, "two of the files have the same name")


def _bounded(request: Request, most: int) -> Receive:
    """The request's bytes, until they are too many."""
    refusal = HTTPException(413, f"too large: at most {most // MEGABYTE} MB may be sent")
    announced = request.headers.get("content-length", "0")
    if announced.isdigit() and int(announced) > most:
        raise refusal
    taken = 0

    async def receive() -> Message:
        nonlocal taken
        message = await request.receive()
        taken += len(message.get("body", b""))
        if taken > most:
            raise refusal
        return message

    return receive


def _unpacked_size(path: Path, most: int) -> int:
    """Bytes in a .gz file, counted no further than just past `most`; what breaks off counts as far as it goes."""
    size, unpacker = 0, zlib.decompressobj(zlib.MAX_WBITS | 16)
    with path.open("rb") as packed:
        while size <= most and (block := packed.read(BLOCK)):
            while block and size <= most:
                try:
                    size += len(unpacker.decompress(block, MEGABYTE))
                except zlib.error:
                    return size
                block = unpacker.unconsumed_tail
                if unpacker.eof:
                    block, unpacker = unpacker.unused_data, zlib.decompressobj(zlib.MAX_WBITS | 16)
    return size
