"""Both planners on one question: what each answers, how they differ, and why one finds what the other does not."""

from dataclasses import dataclass
from time import process_time
from typing import Any

import numpy as np

from frontend.scan import Floats
from planners.path import Answer, Path
from planners.robot import Robot
from planners.world import World
from slam.planning import PLANNERS, PlanningSettings, answer_values

CONES, CELLS = PLANNERS


@dataclass(frozen=True, eq=False)
class Trial:
    """One planner's answer and the seconds of processor time it took, preparation included."""

    answer: Answer
    seconds: float


def trial(name: str, world: World, robot: Robot, ends: tuple[Floats, Floats], settings: PlanningSettings) -> Trial:
    """The answer of the planner of that name from one pose (3,) to another."""
    began = process_time()
    answer = PLANNERS[name](world, robot, *ends, settings)
    return Trial(answer, process_time() - began)


def compare(world: World, robot: Robot, ends: tuple[Floats, Floats], settings: PlanningSettings) -> dict[str, Trial]:
    """A trial of every planner; each is asked once before, so that loading compiled loops does not count."""
    given = world, robot, ends, settings
    return {name: (trial(name, *given), trial(name, *given))[1] for name in PLANNERS}


def trial_values(made: Trial) -> dict[str, Any]:
    """A trial as JSON holds it."""
    path = made.answer.path
    return {
        **answer_values(made.answer),
        "turning": None if path is None else path.turning,
        "seconds": made.seconds,
    }


def verdict(trials: dict[str, Trial], robot: Robot) -> str:
    """How the answers differ, or why one planner finds a path and the other does not."""
    cones, cells = trials[CONES].answer, trials[CELLS].answer
    if cones.path is not None and cells.path is not None:
        longer = 100 * (cones.path.length / max(cells.path.length, np.finfo(float).tiny) - 1)
        wider = cones.path.clearance - cells.path.clearance
        return (
            f"{CONES} goes {abs(longer):.0f} % {'farther' if longer >= 0 else 'less far'} than {CELLS} and keeps "
            f"{abs(wider):.3f} m {'more' if wider >= 0 else 'less'} clearance"
        )
    if cells.path is not None:
        return _missed(cones, cells.path)
    if cones.path is not None:
        return f"{CELLS} cannot tell at its resolution: {cells.reason}; {CONES} is not bound to one"
    if cells.kind == "no path":
        return f"neither can: {CELLS} proves it, so no planner finds a path for a robot {robot.width:.3g} m wide"
    return f"neither found a path, and none is ruled out: {CONES} is a heuristic, {CELLS} stops at its resolution"


def _missed(cones: Answer, path: Path) -> str:
    """Why there is no way along spines, beside a path that the other planner found."""
    moves = np.diff(path.poses, axis=0)
    together = (np.hypot(moves[:, 0], moves[:, 1]) > 0) & (np.abs(moves[:, 2]) > 0)
    why = (
        "the way asks the robot to turn while it moves, and along spines it turns at crossings only"
        if together.any()
        else "the way leaves the middle between walls, to which spines keep"
    )
    return f"only {CELLS} finds a path, of clearance {path.clearance:.3f} m: {why}; {CONES}: {cones.reason}"
