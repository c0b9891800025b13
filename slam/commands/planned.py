"""What becomes of a question to the planners: one or both are asked, files are written, the answer is printed."""

import json
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Any

from rich.table import Table

from planners.compiled import compiling
from planners.path import Answer
from planners.robot import Robot
from slam.commands.console import err, out
from slam.plan_question import Question
from slam.planner_comparison import Trial, compare, trial, trial_values, verdict
from slam.planning import PlanningSettings, paths_text
from slam.whole_output import write_whole

BOTH = "both"


@dataclass(frozen=True)
class Wishes:
    """Who is asked, by name or BOTH, with which settings file, and what is wanted of the answer."""

    planner: str
    settings: Path | None
    to: Path | None
    figure: Path | None
    as_json: bool


def answered(question: Question, wishes: Wishes) -> bool:
    """Ask, write and print; whether any planner found a path."""
    asked = question.source.world, question.robot, question.ends, _opinions(wishes.settings)
    with compiling(announce_compiling):
        trials = compare(*asked) if wishes.planner == BOTH else {wishes.planner: trial(wishes.planner, *asked)}
    answers = {name: made.answer for name, made in trials.items()}
    found = any(answer.path for answer in answers.values())
    if wishes.to is not None and found:
        write_whole(wishes.to, paths_text(answers))
    if wishes.figure is not None:
        _draw(wishes.figure, answers, question)
    if wishes.as_json:
        print(json.dumps({**_values(trials, question.robot), "layer": question.source.taken}))
    else:
        _print(trials, question.robot)
    return found


def announce_compiling() -> None:
    """Say why the first plan takes long."""
    err.print("compiling the planners' loops: once after each installation, up to a minute")


def told(answer: Answer) -> str:
    """One answer of a planner as a sentence."""
    if answer.path is None:
        return f"{answer.kind}: {answer.reason}"
    path = answer.path
    return f"path of {path.length:.3f} m, clearance {path.clearance:.3f} m, {len(path.poses)} poses: {answer.reason}"


def _opinions(settings: Path | None) -> PlanningSettings:
    if settings is None:
        return PlanningSettings()
    # The whole tree of settings brings every stage with it: only who changes some waits for that.
    from slam import toml_file  # noqa: PLC0415
    from slam.settings import Settings  # noqa: PLC0415

    return toml_file.load(settings, Settings).planning


def _draw(figure: Path, answers: dict[str, Answer], question: Question) -> None:
    # Drawing costs more to load than a plan to make: only who wants a figure waits for that.
    from slam.figures.plans import draw_plans, png_of  # noqa: PLC0415

    write_whole(figure, png_of(draw_plans(answers, question.source.world, question.robot, question.ends)))


def _values(trials: dict[str, Trial], robot: Robot) -> dict[str, Any]:
    """The answer as JSON holds it; of both, each by name and how they compare."""
    values = {name: trial_values(made) for name, made in trials.items()}
    if len(values) == 1:
        return next(iter(values.values()))
    return {**values, "comparison": verdict(trials, robot)}


def _print(trials: dict[str, Trial], robot: Robot) -> None:
    if len(trials) == 1:
        out.print(*(told(made.answer) for made in trials.values()), markup=False)
        return
    table = Table("", "length (m)", "clearance (m)", "turning (°)", "time (s)", "poses", box=None)
    for name, made in trials.items():
        path = made.answer.path
        numbers = (
            ["–"] * 3
            if path is None
            else [f"{path.length:.3f}", f"{path.clearance:.3f}", f"{degrees(path.turning):.0f}"]
        )
        table.add_row(name, *numbers, f"{made.seconds:.3f}", "–" if path is None else str(len(path.poses)))
    out.print(table)
    for name, made in trials.items():
        out.print(f"{name}: {made.answer.reason}", markup=False)
    out.print(verdict(trials, robot), markup=False)
