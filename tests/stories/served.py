"""The web view as a user starts it: a process of its own, its address, and how it ends."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parents[2]


@dataclass(frozen=True)
class Served:
    """A running server, and the address it printed."""

    process: subprocess.Popen[str]
    address: str

    def interrupt(self) -> int:
        """Ctrl-C; its exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(20)


@contextmanager
def serving(*arguments: object) -> Iterator[Served]:
    """`roomsketch view` on any free port, without a browser, until the block ends."""
    command = [sys.executable, "-m", "slam", "view", *map(str, arguments), "--port", "0", "--no-browser"]
    told = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        command, cwd=HERE, env=told, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    ) as process:
        assert process.stdout is not None
        line = process.stdout.readline()
        found = re.match(r"http://\S+", line)
        assert found, line + process.stdout.read()
        try:
            yield Served(process, found.group())
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                process.wait(20)
