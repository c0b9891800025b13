"""The logbook of a run: what registration answered, in order, so that a resumed run reads instead of searching.

All else that a mapper knows follows at little cost from its scans and these answers.
"""

import base64
import json
from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

from frontend.registration import Alignment
from slam.loops import Tried
from slam.tracking import Placed

Answer = TypeVar("Answer")

KINDS: dict[str, type[Any]] = {"placed": Placed, "tried": Tried, "alignment": Alignment}


class Logbook:
    """Answers as lines of text, each known to the last bit; the known ones are read first, new ones are appended."""

    def __init__(self, lines: Sequence[str] = ()) -> None:
        self.lines = list(lines)
        self._read = 0

    def answer(self, ask: Callable[[], Answer]) -> Answer:
        """The next answer: from the logbook while it lasts, then by asking."""
        if self._read == len(self.lines):
            found = ask()
            self.lines.append(json.dumps(_packed(found)))
        else:
            found = _unpacked(json.loads(self.lines[self._read]))
        self._read += 1
        return found


def _packed(value: Any) -> Any:
    """Arrays as their type, shape and bytes; numbers as Python's, whose text is exact; tuples as lists."""
    if isinstance(value, np.ndarray):
        content = base64.b64encode(np.ascontiguousarray(value).tobytes()).decode()
        return {"array": [value.dtype.str, list(value.shape), content]}
    if isinstance(value, tuple):
        return [_packed(part) for part in value]
    for name, kind in KINDS.items():
        if isinstance(value, kind):
            return {name: {field.name: _packed(getattr(value, field.name)) for field in fields(value)}}
    return value.item() if isinstance(value, np.generic) else value


def _unpacked(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(_unpacked(part) for part in value)
    if not isinstance(value, dict):
        return value
    ((name, content),) = value.items()
    if name == "array":
        kind, shape, packed = content
        return np.frombuffer(base64.b64decode(packed), np.dtype(kind)).reshape(shape).copy()
    return KINDS[name](**{key: _unpacked(part) for key, part in content.items()})
