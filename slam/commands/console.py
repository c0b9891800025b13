"""What the commands print with: results on standard output, troubles and progress on standard error."""

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import track
from rich.table import Table

if TYPE_CHECKING:
    from frontend.scan import Scan

NOTHING = {
    "precision": "none claimed",
    "recall": "none in truth",
    "error": "none found",
}  # by what a figure's name ends in

out = Console(soft_wrap=True, highlight=False, markup=False)
err = Console(stderr=True, soft_wrap=True, highlight=False, markup=False)


def progress(scans: "tuple[Scan, ...]") -> "Iterable[Scan]":
    """The scans, with a bar on standard error while they are taken; silent when that is no terminal."""
    return track(scans, description="scans", console=err, transient=True, disable=not err.is_terminal)


def print_values(values: dict[str, Any]) -> None:
    """Print nested figures as one table of names and values."""
    table = Table("figure", "value", box=None)
    for name, value in _flat(values):
        table.add_row(name, _worded(name, value) if isinstance(value, float) else str(value))
    out.print(table)


def _worded(name: str, value: float) -> str:
    """The number, or in words why there is none."""
    if not math.isnan(value):
        return f"{value:.4g}"
    return next((words for ending, words in NOTHING.items() if name.endswith(ending)), "nothing to measure")


def _flat(values: dict[str, Any], prefix: str = "") -> Iterable[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}: ")
        else:
            yield f"{prefix}{name}".replace("_", " "), value
