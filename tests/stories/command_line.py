"""The command line as a user meets it: what it prints where, and its exit code."""

import contextlib
import io
import sys
from dataclasses import dataclass
from unittest import mock

from slam.cli import main


@dataclass(frozen=True)
class Told:
    """The exit code, standard output and standard error of one command."""

    code: int
    out: str
    err: str


def run(*arguments: object) -> Told:
    """Run `roomsketch` with these arguments in this process."""
    code, out, err = 0, io.StringIO(), io.StringIO()
    command = ["roomsketch", *map(str, arguments)]
    with mock.patch.object(sys, "argv", command), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 0
    return Told(code, out.getvalue(), err.getvalue())
