"""A run as one HTML page that needs nothing else: map, figures, scores, timings, and what was refused."""

import base64
from collections import defaultdict
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from slam.exports.drawing import LOOKS, svg_text
from slam.exports.product import load_product
from slam.result_folder import read_report
from slam.whole_output import write_whole

PAGE = "report.html"
MOST_REFUSED = 200  # rows of one kind that a reader may want to look through; report.json has them all

STYLE = """
:root { color-scheme: light dark; --ink: #1b1b1b; --faint: #6b6b6b; --line: #d9d9d9; --ground: #fff; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8e8e8; --faint: #a0a0a0; --line: #3a3a3a; --ground: #16181b; } }
body { font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--ground); max-width: 62rem;
  margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin: 0; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; }
p.about { color: var(--faint); margin: .2rem 0 1.5rem; overflow-wrap: anywhere; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
td, th { text-align: left; padding: .2rem 1.2rem .2rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.number { text-align: right; }
.columns { display: flex; flex-wrap: wrap; gap: 0 3rem; }
svg, img { width: 100%; height: auto; background: #fff; border: 1px solid var(--line); border-radius: 4px; }
svg { max-height: 80vh; } figure { margin: 0 0 1.5rem; } figcaption, summary { color: var(--faint); }
summary { cursor: pointer; padding: .2rem 0; } .scroll { overflow-x: auto; }
.key { display: inline-block; width: 1.6em; border-top: 3px solid; vertical-align: middle; margin: 0 .4em 0 1em; }
"""


def write_page(folder: Path) -> None:
    """Put the page of a result folder in its place. Raises ResultError or RoomFileError."""
    write_whole(folder / PAGE, page(folder))


def page(folder: Path) -> str:
    """The whole page, pictures and all."""
    report = read_report(folder)
    name = escape(report["recording"]["name"])
    return "\n".join(
        [
            "<!DOCTYPE html>",
            f'<html lang="en"><head><meta charset="utf-8"><title>{name}: room map</title>',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<style>{STYLE}</style></head><body>",
            f"<h1>{name}</h1>",
            f'<p class="about">{_about(report["recording"])}</p>',
            _map(folder, report["paths"]),
            *_planned(report),
            *_numbers(report),
            *_figures(folder / "figures"),
            *_refused(report),
            "</body></html>\n",
        ]
    )


def _about(recording: dict[str, Any]) -> str:
    further = [str(path) for path in recording.get("further", ())]
    places = ", ".join([str(recording["path"]), *further])
    return escape(f"{recording['sensor']}, reaching {recording['max_range']:g} m; from {places}")


def _map(folder: Path, paths: dict[str, Any]) -> str:
    ways = {name: np.array(answer["poses"]) for name, answer in paths.items() if answer["poses"]}
    keys = "".join(
        f'<span class="key" style="border-top: 3px {"dashed" if dashes else "solid"} {colour}"></span>{layer}'
        for layer, (colour, dashes, _) in LOOKS.items()
    )
    drawing = svg_text(load_product(folder), ways)
    return f"<figure>{drawing}<figcaption>{keys}<br>Point at an edge: it tells who saw it.</figcaption></figure>"


def _planned(report: dict[str, Any]) -> Iterable[str]:
    rows = [
        (name, answer["answer"], answer["length"], answer["clearance"], answer["reason"])
        for name, answer in report["paths"].items()
    ]
    if rows:
        yield "<h2>Planned on it</h2>"
        yield _table(("planner", "answer", "length (m)", "clearance (m)", "in words"), rows)
    if report.get("tour"):
        yield f"<p>No path planned: {escape(str(report['tour']))}</p>"


def _numbers(report: dict[str, Any]) -> Iterable[str]:
    sections = {"Counts": report["counts"], "Seconds": report["timings"], "Calibration": report["calibration"]}
    yield '<div class="columns">'
    for title, values in (sections | {f"Scores: {name}": part for name, part in report["scores"].items()}).items():
        yield f"<section><h2>{escape(title)}</h2>{_table((), list(_flat(values)))}</section>"
    yield "</div>"


def _figures(folder: Path) -> Iterable[str]:
    pictures = sorted(folder.glob("*.png")) if folder.is_dir() else []
    if pictures:
        yield "<h2>Figures</h2>"
    for picture in pictures:
        content = base64.b64encode(picture.read_bytes()).decode()
        caption = escape(picture.stem.replace("_", " "))
        yield f'<figure><img alt="{caption}" src="data:image/png;base64,{content}">'
        yield f"<figcaption>{caption}</figcaption></figure>"


def _refused(report: dict[str, Any]) -> Iterable[str]:
    kinds: dict[str, list[tuple[Any, ...]]] = defaultdict(list)
    for made in report["rejected"]:
        kinds[made["what"]].append((", ".join(map(str, made["scans"])), made["reason"]))
    yield "<h2>Refused, and why</h2>"
    if not kinds and not report["damaged_lines"]:
        yield "<p>Nothing: every reading, match and loop was used.</p>"
    for what, rows in kinds.items():
        more = f", the first {MOST_REFUSED}" if len(rows) > MOST_REFUSED else ""
        yield f"<details><summary>{escape(what)}: {len(rows)}{more}</summary>"
        yield f"{_table(('scans', 'reason'), rows[:MOST_REFUSED])}</details>"
    if report["damaged_lines"]:
        lines = [(line,) for line in report["damaged_lines"][:MOST_REFUSED]]
        yield f"<details><summary>lines left out or mended: {len(report['damaged_lines'])}</summary>"
        yield f"{_table((), lines)}</details>"


def _table(heads: tuple[str, ...], rows: list[tuple[Any, ...]]) -> str:
    head = f"<tr>{''.join(f'<th>{escape(head)}</th>' for head in heads)}</tr>" if heads else ""
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    return f'<div class="scroll"><table>{head}{body}</table></div>'


def _cell(value: Any) -> str:
    if isinstance(value, int | float):
        return (
            f'<td class="number">{value:.4g}</td>' if isinstance(value, float) else f'<td class="number">{value}</td>'
        )
    return f"<td>{'–' if value is None else escape(str(value))}</td>"


def _flat(values: dict[str, Any], prefix: str = "") -> Iterable[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}: ")
        else:
            yield f"{prefix}{name}".replace("_", " "), value
