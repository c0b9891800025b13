"""Other planners for a disc, run by an interpreter that has them: tasks as JSON on stdin, answers as the last line.

A task is the free space of the disc's centre as rings, and queries. Planners that cannot be imported are left out.
"""

import importlib
import json
import sys
from time import perf_counter
from typing import Any

import numpy as np
import shapely
from shapely import Polygon

Answer = dict[str, Any]


def sampled(task: Answer, name: str, seconds: float) -> list[Answer]:
    """OMPL's answers in the plane; RRTConnect is followed by OMPL's own simplification."""
    base, geometric, util = (importlib.import_module(f"ompl.{part}") for part in ("base", "geometric", "util"))
    util.setLogLevel(util.LogLevel.LOG_NONE)
    free = Polygon(task["rings"][0], task["rings"][1:])
    shapely.prepare(free)
    space, limits = base.RealVectorStateSpace(2), base.RealVectorBounds(2)
    for axis, (low, high) in enumerate(zip(free.bounds[:2], free.bounds[2:], strict=True)):
        limits.setLow(axis, low)
        limits.setHigh(axis, high)
    space.setBounds(limits)
    answers = []
    for query in task["queries"]:
        setup, ends = geometric.SimpleSetup(space), [space.allocState(), space.allocState()]
        for state, point in zip(ends, query, strict=True):
            state[0], state[1] = point
        setup.setStateValidityChecker(lambda state: bool(shapely.contains_xy(free, state[0], state[1])))
        setup.setStartAndGoalStates(*ends)
        setup.setPlanner(getattr(geometric, name)(setup.getSpaceInformation()))
        began = perf_counter()
        setup.solve(seconds)
        if name == "RRTConnect" and setup.haveExactSolutionPath():
            setup.simplifySolution()
        took, points = perf_counter() - began, None
        if setup.haveExactSolutionPath():
            path = setup.getSolutionPath()
            points = [[path.getState(k)[0], path.getState(k)[1]] for k in range(path.getStateCount())]
        answers.append({"points": points, "seconds": took})
    return answers


def extremities(task: Answer) -> list[Answer]:
    """The visibility graph of extremitypathfinder; preparation is shared out evenly over the queries."""
    rings = [np.array(ring)[:-1] for ring in task["rings"]]
    environment = importlib.import_module("extremitypathfinder").PolygonEnvironment()
    began = perf_counter()
    environment.store(rings[0], rings[1:], validate=False)
    environment.prepare()
    prepared, answers = perf_counter() - began, []
    for start, goal in task["queries"]:
        began = perf_counter()
        points, _ = environment.find_shortest_path(tuple(start), tuple(goal))
        took = perf_counter() - began
        answers.append({"points": [list(p) for p in points] or None, "seconds": took, "prepared": prepared})
    return answers


def main() -> None:
    """Answer every task with every planner that is there."""
    found: dict[str, list[list[Answer]]] = {}
    tasks = json.load(sys.stdin)
    planners = {
        "OMPL BIT*, 1 s": lambda task: sampled(task, "BITstar", 1.0),
        "OMPL RRTConnect + simplify": lambda task: sampled(task, "RRTConnect", 10.0),
        "extremitypathfinder": extremities,
    }
    for name, planner in planners.items():
        try:
            found[name] = [planner(task) for task in tasks]
        except ImportError:
            continue
    sys.stdout.write("\n" + json.dumps(found) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
