"""Output that is there whole or not at all: written under a hidden name beside its place, then renamed into it."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

RESULT_MARK = "report.json"


class OutputError(Exception):
    """An output that cannot be written where it was asked for."""


def write_whole(path: Path, content: str | bytes) -> None:
    """Put `content` at `path`; whoever reads meanwhile sees the old content or the new, never half."""
    hidden = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        hidden.write_bytes(content if isinstance(content, bytes) else content.encode())
        hidden.replace(path)
    except OSError as reason:
        raise OutputError(f"{path} cannot be written: {reason.strerror or reason}") from reason
    finally:
        if hidden.exists():
            hidden.unlink()


@contextmanager
def whole_folder(folder: Path, mark: str = RESULT_MARK) -> Iterator[Path]:
    """An empty folder to fill; on success it takes the place of `folder`, on failure nothing is left of it.

    Only a folder with the file `mark` gives way: whatever else lies in `folder` is not ours to delete. Raises
    OutputError, also for what whoever fills the folder cannot write into it.
    """
    check_place(folder, mark)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        hidden = Path(mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
    except OSError as reason:
        raise OutputError(f"{folder} cannot be made: {reason.strerror or reason}") from reason
    gone = hidden.with_name(f"{hidden.name}.earlier")
    try:
        yield hidden
        hidden.chmod(0o755)
        if folder.exists():
            # Killed between the two names, the earlier run is still there under the hidden one.
            folder.rename(gone)
        hidden.rename(folder)
    except OSError as reason:
        raise OutputError(f"{folder} cannot be written: {reason.strerror or reason}") from reason
    except OutputError as reason:
        # Nobody knows the hidden name, and nothing is left of it.
        raise OutputError(str(reason).replace(str(hidden), str(folder))) from reason
    finally:
        shutil.rmtree(hidden, ignore_errors=True)
        if folder.exists():
            shutil.rmtree(gone, ignore_errors=True)
        elif gone.exists():
            gone.rename(folder)


def check_place(folder: Path, mark: str = RESULT_MARK) -> None:
    """Raise OutputError unless `folder` is free, empty or holds the file `mark` of an earlier run."""
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder} is a file, but a folder is to be written there")
    if folder.is_dir() and any(folder.iterdir()) and not (folder / mark).exists():
        raise OutputError(f"{folder} holds other files and no {mark} of an earlier run: choose another folder")
