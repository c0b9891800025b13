"""Planners: soundness, success, length, clearance and time, beside OMPL, extremitypathfinder and a Voronoi roadmap.

Worlds and optima lie beside the folder that ROOMSKETCH_DATA names. ROOMSKETCH_PEERS may name a Python that has ompl and
extremitypathfinder; peers are measured in the same run where they can be imported.
"""

import json
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from planners import configuration_space, generalized_cones
from planners.certify import certify
from planners.configuration_space import ConfigurationSpaceSettings
from planners.generalized_cones import ConesSettings
from planners.path import Answer
from planners.robot import Robot
from planners.visibility import eroded
from planners.world import World
from tests.benchmarks.planner_soak import Soak, corridors, soak
from tests.benchmarks.voronoi_roadmap import voronoi_ways
from tests.planners.flood_fill import refutations
from tests.planners.known_worlds import CRITICAL_CORNER, LONG, corner, corner_query, door, shared_worlds, world_of

Floats = NDArray[np.float64]
Row = dict[str, Any]

FINE = ConfigurationSpaceSettings(resolution=0.1)
RAW = ConesSettings()
SHORT = replace(RAW, shortcuts=300)
REPEATS = 5  # of every query, for a median
RIVALS = Path(__file__).with_name("planner_rivals.py")
NAMES = ("room", "office", "big")


def rows() -> list[Row]:
    """All rows of the table of targets."""
    worlds = shared_worlds()
    _warm_up()
    return [*_soundness(), *_discs(worlds), *_with_rotation(worlds), *_constants()]


def _row(name: str, value: float, unit: str, better: str, target: float | str, **more: Any) -> Row:
    row = {"part": "planners", "name": name, "value": value, "unit": unit, "better": better, "target": target}
    return row | {"peers": {}, "runs": 1, "note": ""} | more


def _warm_up() -> None:
    """Compile every loop."""
    for robot in (LONG, Robot.disc(2)):
        generalized_cones.plan(door(9), robot, [15, 45, 1.2], [85, 15, -2.0], replace(RAW, shortcuts=3))
        configuration_space.plan(door(9), robot, [15, 45, 1.2], [85, 15, -2.0], FINE)


def _timed(action: Callable[..., Any], *given: Any) -> tuple[Any, float]:
    began = process_time()
    return action(*given), process_time() - began


def _repeated(action: Callable[..., Any], *given: Any) -> tuple[Any, float]:
    """The result and the median of the seconds."""
    runs = [_timed(action, *given) for _ in range(REPEATS)]
    return runs[0][0], _median([seconds for _, seconds in runs])


def _soundness() -> list[Row]:
    counts: Soak = soak(worlds=200, each=10)
    total, kinds = counts.queries["all"], dict(sorted(counts.kinds.items()))
    table: list[Row] = []
    for name in ("cones", "boxes"):
        table.append(
            _row(f"{name}: invalid paths", counts.invalid[name], "paths", "lower", 0, runs=total, note=str(kinds))
        )
        table.append(_row(f"{name}: exceptions", counts.raised[name], "queries", "lower", 0, runs=total))
    note = "refuted by a path of the other planner or by the widest way for the enclosing disc"
    refuted = counts.refuted["boxes"]
    floods = sum((refutations(np.random.default_rng(seed), 3, 0.5) for seed in range(100, 160)), Counter[str]())
    return [
        *table,
        _row("boxes: false NO PATH", refuted, "answers", "lower", 0, runs=total, note=note),
        _row(
            "boxes: NO PATH refuted by flooding a grid",
            floods["refuted"],
            "answers",
            "lower",
            0,
            runs=60,
            note=str(dict(sorted(floods.items()))),
        ),
    ]


@dataclass(frozen=True, eq=False)
class Ways:
    """What the disc queries of one world gave: ratios to the optimum, clearances in radii, seconds per step."""

    raw: list[float]
    shortened: list[float]
    exact: list[float]
    kept: list[float]
    seconds: dict[str, float]


def _ways(record: dict[str, Any]) -> Ways:
    world, robot = world_of(record), Robot.disc(record["disc_radius"])
    asked = [query for query in record["disc_queries"] if query["feasible"]]
    cones, prepared = _timed(generalized_cones.prepare, world, robot, RAW)
    roadmap, charted = _timed(configuration_space.prepare, world, robot, FINE)
    shorter = generalized_cones.prepare(world, robot, SHORT)
    ways, taken, looked = Ways([], [], [], [], {"cones": prepared, "disc": charted}), [], []
    for query in asked:
        ends = [*query["start"], 0.0], [*query["goal"], 0.0]
        answer, seconds = _repeated(generalized_cones.query, cones, *ends)
        best, looking = _repeated(configuration_space.query, roadmap, *ends)
        taken.append(seconds)
        looked.append(looking)
        ways.raw.append(_ratio(answer, robot, world, query["shortest"]))
        ways.shortened.append(_ratio(generalized_cones.query(shorter, *ends), robot, world, query["shortest"]))
        ways.exact.append(_ratio(best, robot, world, query["shortest"]))
        ways.kept.append(0.0 if answer.path is None else 1 + answer.path.clearance / robot.radius)
    ways.seconds.update({"cones query": _median(taken), "disc query": _median(looked)})
    return ways


def _discs(worlds: dict[str, Any]) -> list[Row]:
    by_world = {name: _ways(worlds[name]) for name in NAMES}
    table = [row for name, ways in by_world.items() for row in _times(name, ways)]
    raw, shortened = ([r for w in by_world.values() for r in getattr(w, kind)] for kind in ("raw", "shortened"))
    exact, kept = ([r for w in by_world.values() for r in getattr(w, kind)] for kind in ("exact", "kept"))
    rivals, total = _rivals(worlds), len(raw)
    solved = {name: sum(np.isfinite(ratios)) for name, ratios in rivals["solved"].items()}
    voronoi = [way for name in NAMES for way in _voronoi(worlds[name])]
    peers = rivals["ratios"] | {"Voronoi roadmap": _median([way["ratio"] for way in voronoi])}
    medians = {"better": "lower", "runs": total, "peers": peers}
    found = int(np.isfinite(raw).sum())
    note = "peers: the ten queries of room and office"
    return [
        *table,
        _row(
            "cones: feasible disc queries solved",
            found,
            "queries",
            "higher",
            total,
            runs=total,
            peers=solved,
            note=note,
        ),
        _row("cones: length / optimum, raw", _median(raw), "", target=1.25, note=_worst(raw), **medians),
        _row(
            "cones: length / optimum, shortened", _median(shortened), "", target=1.03, note=_worst(shortened), **medians
        ),
        _row("disc: length / optimum, worst", max(exact), "", target=1.0002, note="peers: medians", **medians),
        _row(
            "cones: clearance of the centre, raw",
            _median(kept),
            "radii",
            "higher",
            1.2,
            runs=total,
            peers={"Voronoi roadmap": _median([way["clearance"] for way in voronoi])},
        ),
    ]


def _voronoi(record: dict[str, Any]) -> list[dict[str, float]]:
    asked = [query for query in record["disc_queries"] if query["feasible"]]
    return voronoi_ways(world_of(record), record["disc_radius"], asked)


def _times(name: str, ways: Ways) -> list[Row]:
    limit, runs = {"room": 0.1, "office": 0.5, "big": 3.0}[name], len(ways.raw)
    return [
        _row(f"cones: prepare {name}", ways.seconds["cones"], "s", "lower", limit),
        _row(f"cones: query {name}", 1e3 * ways.seconds["cones query"], "ms", "lower", 10, runs=runs),
        _row(f"disc: prepare {name}", ways.seconds["disc"], "s", "lower", 2.0),
        _row(f"disc: query {name}", 1e3 * ways.seconds["disc query"], "ms", "lower", 1.0, runs=runs),
    ]


def _ratio(answer: Answer, robot: Robot, world: World, shortest: float) -> float:
    """Length over the optimum; infinite without a path or for one that is not certified."""
    if answer.path is None or not certify(answer.path.poses, robot, world.free):
        return float("inf")
    return answer.path.length / shortest


def _median(values: list[float]) -> float:
    return float(np.median(values))


def _worst(ratios: list[float]) -> str:
    return f"median; worst {max(ratios):.3f}"


def _rivals(worlds: dict[str, Any]) -> dict[str, Any]:
    """Ratios of other planners on the same disc queries of room and office, median over what they solved."""
    tasks, optima = [], []
    for name in ("room", "office"):
        record = worlds[name]
        parts = eroded(world_of(record).free, record["disc_radius"] * 1.001)
        largest = max(parts, key=lambda part: part.area)
        rings = [np.asarray(ring.coords).tolist() for ring in (largest.exterior, *largest.interiors)]
        queries = [query for query in record["disc_queries"] if query["feasible"]]
        tasks.append({"rings": rings, "queries": [[query["start"], query["goal"]] for query in queries]})
        optima += [query["shortest"] for query in queries]
    python = os.environ.get("ROOMSKETCH_PEERS", sys.executable)
    run = subprocess.run([python, str(RIVALS)], input=json.dumps(tasks), capture_output=True, text=True, check=True)
    answers = json.loads(next(line for line in reversed(run.stdout.splitlines()) if line.startswith("{")))
    solved: dict[str, list[float]] = {}
    for planner, by_task in answers.items():
        lengths = [_length(answer["points"]) for task in by_task for answer in task]
        solved[planner] = [length / best for length, best in zip(lengths, optima, strict=True)]
    medians = {planner: _median([ratio for ratio in found if np.isfinite(ratio)]) for planner, found in solved.items()}
    return {"solved": solved, "ratios": medians}


def _length(points: list[list[float]] | None) -> float:
    return float("inf") if points is None else float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _with_rotation(worlds: dict[str, Any]) -> list[Row]:
    table = []
    for name in ("door_10", "door_9", "corner_14", "corner_13", "room", "office"):
        record = worlds[name]
        query, robot = record["rectangle_queries"][0], Robot.rectangle(*record["rectangle"])
        answer, seconds = _median_run(world_of(record), robot, query, FINE)
        sound = answer.path is not None and bool(certify(answer.path.poses, robot, world_of(record).free))
        limit = 0.5 if name in NAMES else 0.3
        table.append(_row(f"boxes: {name}", seconds if sound else float("inf"), "s", "lower", limit, runs=3))
        if name in NAMES and answer.path is not None:
            ratio = answer.path.length / query["best_known_length"]
            table.append(_row(f"boxes: length / best known, {name}", ratio, "", "lower", 1.05))
    for name in ("door_7.9", "corner_12.5"):
        record = worlds[name]
        query, robot = record["rectangle_queries"][0], Robot.rectangle(*record["rectangle"])
        answer, seconds = _median_run(world_of(record), robot, query, replace(FINE, smaller_robots=0))
        proved = answer.kind == "no path" and answer.gap is not None
        explained, more = _median_run(world_of(record), robot, query, FINE)
        table.append(_row(f"boxes: {name} proved shut", seconds if proved else float("inf"), "s", "lower", 0.5, runs=3))
        wide = explained.gap.width if explained.gap is not None else float("nan")
        error, note = abs(wide - float(name.split("_")[1])), f"{explained.reason}; with this explanation {more:.2f} s"
        table.append(_row(f"boxes: {name}, error of the gap", error, "", "lower", 0.1, note=note))
    return [*table, _big(worlds["big"])]


def _big(record: dict[str, Any]) -> Row:
    """The rectangle of the big world on the ways that are asked of its disc, any heading at both ends."""
    world, robot, taken = world_of(record), Robot.rectangle(*record["rectangle"]), []
    for query in record["disc_queries"]:
        if query["feasible"]:
            ends = [*query["start"], None], [*query["goal"], None]
            answer, seconds = _timed(configuration_space.plan, world, robot, *ends, FINE)
            taken.append(seconds if np.isfinite(_ratio(answer, robot, world, query["shortest"])) else float("inf"))
    return _row("boxes: big", _median(taken), "s", "lower", 3.0, runs=len(taken))


def _median_run(
    world: World, robot: Robot, query: dict[str, Any], settings: ConfigurationSpaceSettings
) -> tuple[Answer, float]:
    given = world, robot, query["start"], query["goal"], settings
    runs = [_timed(configuration_space.plan, *given) for _ in range(3)]
    return runs[0][0], float(np.median([seconds for _, seconds in runs]))


def _constants() -> list[Row]:
    step, count = FINE.resolution, 500
    wide, narrow = CRITICAL_CORNER + 3 * step, CRITICAL_CORNER - 3 * step
    turned = configuration_space.plan(corner(wide), LONG, *corner_query(wide), FINE).kind == "path"
    stuck = configuration_space.plan(corner(narrow), LONG, *corner_query(narrow), FINE).kind == "no path"
    note = "PATH at 12.728 + 3 resolutions, NO PATH at 12.728 - 3 resolutions"
    return [
        _row("boxes: critical corner", int(turned) + int(stuck), "of 2", "higher", 2, note=note),
        _row("boxes: corridors of 2.43 resolutions passed", corridors(count, 0.2), "", "higher", count, runs=count),
    ]
