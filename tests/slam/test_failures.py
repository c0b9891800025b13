"""Every error class of the project either becomes one sentence for the user or never leaves its stage."""

import re
from pathlib import Path

from slam.failures import all_failures, is_foreseen

ROOT = Path(__file__).parents[2]
# Told apart inside: a reader's sieve turns the first into a RecordingError, the page shows the second as its sentence;
# arrays of our own making break the others.
INTERNAL = {
    "LineError",
    "TaskError",
    "ViewError",
    "SurfaceError",
    "GraphError",
    "ThinRectangleError",
    "RefinementError",
}


def test_no_error_class_reaches_the_user_as_a_traceback() -> None:
    sources = [
        path for package in ("slam", "frontend", "backend", "planners") for path in (ROOT / package).rglob("*.py")
    ]
    found = {name for path in sources for name in re.findall(r"^class (\w+Error)\b", path.read_text(), re.MULTILINE)}
    assert found - INTERNAL == {failure.__name__ for failure in all_failures()} - {PermissionError.__name__}


def test_what_is_foreseen_is_told_from_what_is_a_bug() -> None:
    assert all(is_foreseen(failure("says why")) for failure in all_failures())
    assert not is_foreseen(ValueError("shapes differ"))
    assert not is_foreseen(FileNotFoundError("a file of ours"))
