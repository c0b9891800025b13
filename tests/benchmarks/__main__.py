"""The driver of `make bench`: each part's rows as a table, and all of them in build/bench.json.

`python -m tests.benchmarks [PART]`; a part is a file of this folder with a function `rows`.
"""

import importlib
import importlib.util
import json
import math
import sys
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from slam.result_folder import plain
from slam.whole_output import write_whole

HERE = Path(__file__).parent
RESULTS = HERE.parents[1] / "build" / "bench.json"
Row = dict[str, Any]
console = Console(highlight=False, width=None if sys.stdout.isatty() else 180)


def parts() -> list[str]:
    """Names of the benchmark files that have rows to show."""
    return [path.stem for path in sorted(HERE.glob("[a-z]*.py")) if "def rows(" in path.read_text(encoding="utf-8")]


def main(only: str | None) -> None:
    """Measure, print, and replace the measured parts' rows in the file of results."""
    chosen = [only] if only else parts()
    unknown = set(chosen) - set(parts())
    if unknown:
        sys.exit(f"no benchmark is called {', '.join(unknown)}; there are {', '.join(parts())}")
    earlier = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else []
    rows = [row for row in earlier if row["file"] not in chosen]
    for part in chosen:
        measured = [{"file": part, **row} for row in importlib.import_module(f"tests.benchmarks.{part}").rows()]
        show(part, measured)
        rows += measured
        write_whole(RESULTS, json.dumps(plain([_noted(row) for row in rows]), indent=1, allow_nan=False) + "\n")
    console.print(f"{len(rows)} rows in {RESULTS}")


def _noted(row: Row) -> Row:
    """A row whose value JSON cannot hold: it is written as null, and the note says what it was."""
    value = row["value"]
    if value is None or math.isfinite(value):
        return row
    return {**row, "note": f"measured {value}; {row['note']}".removesuffix("; ")}


def show(part: str, rows: list[Row]) -> None:
    """One table; a value that misses its target is marked."""
    table = Table("", "figure", "value", "target", "others", "runs", "note", title=part)
    for row in rows:
        peers = ", ".join(f"{name} {_short(value)}" for name, value in (row.get("peers") or {}).items())
        value = f"{_short(row['value'])} {row['unit']}".strip()
        table.add_row(_mark(row), row["name"], value, _short(row["target"]), peers, str(row["runs"]), row["note"])
    console.print(table)


def _mark(row: Row) -> str:
    if row["target"] is None:
        return ""
    met = row["value"] <= row["target"] if row["better"] == "lower" else row["value"] >= row["target"]
    return "met" if met else "MISSED"


def _short(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)
