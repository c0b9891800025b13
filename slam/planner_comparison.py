"""Both planners on one question: what each answers, how they differ, and why one finds what the other does not."""

from dataclasses import dataclass
from time import process_time
from typing import Any

import numpy as np
from shapely import box

from frontend.scan import Floats
from planners.beyond_cones import beyond
from planners.circular import spoken
from planners.path import Answer, Path
from planners.robot import Robot
from planners.world import World
from slam.plan_question import CELLS, CONES
from slam.planning import PLANNERS, PlanningSettings, answer_values

LOOK = 0.0625  # widths of the robot between two looks at a path; larger may step over what a short slice loses
STANDING = 1e-6  # metres: a path that is shorter stays where it is


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
    """A trial of every planner; each is asked something small before, so that loading compiled loops does not count."""
    for name in PLANNERS:
        trial(name, *_small_question(robot), settings)
    return {name: trial(name, world, robot, ends, settings) for name in PLANNERS}


def _small_question(robot: Robot) -> tuple[World, Robot, tuple[Floats, Floats]]:
    """A square with a block in its middle, to be gone round: anything a robot of that size may need."""
    far, near, middle = 12 * robot.reach, 2 * robot.reach, 6 * robot.reach
    block = box(middle - near, middle - near, middle + near, middle + near)
    ends = np.array([near, middle, 0.0]), np.array([far - near, middle, np.pi / 2])
    return World.from_obstacles(box(0, 0, far, far), [block]), robot, ends


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
        wider = cones.path.clearance - cells.path.clearance
        return (
            f"{_lengths(cones.path.length, cells.path.length)} and keeps "
            f"{abs(wider):.3f} m {'more' if wider >= 0 else 'less'} clearance"
        )
    if cells.path is not None:
        why = missed(cones, cells.path, robot)
        return f"only {CELLS} finds a path, of clearance {cells.path.clearance:.3f} m: {why}; {CONES}: {cones.reason}"
    if cones.path is not None:
        return f"{CELLS} cannot tell at its resolution: {cells.reason}; {CONES} is not bound to one"
    if cells.kind == "no path":
        return f"neither can: {CELLS} proves it, so no planner finds a path for a robot {robot.width:.3g} m wide"
    return f"neither found a path, and none is ruled out: {CONES} is a heuristic, {CELLS} stops at its resolution"


def _lengths(cones: float, cells: float) -> str:
    """How far one planner goes, metres, beside the other: a share of nothing says nothing."""
    if max(cones, cells) < STANDING:
        return f"{CONES}, like {CELLS}, stays where it is"
    if cells < STANDING:
        return f"{CONES} goes {cones:.3f} m where {CELLS} stays in its place"
    longer = 100 * (cones / cells - 1)
    return f"{CONES} goes {abs(longer):.0f} % {'farther' if longer >= 0 else 'less far'} than {CELLS}"


def missed(cones: Answer, path: Path, robot: Robot) -> str:
    """What the cones say to a path that the other planner found: where no slice of theirs keeps its heading."""
    found = beyond(cones.cones, path.poses, LOOK * robot.width, robot.reach)
    if found is None:
        return "slices keep its headings all along, but no crossings or ways in join them"
    x, y, heading = found.pose
    if not found.slices:
        return f"it passes ({x:.2f}, {y:.2f}), which none of the {len(cones.cones)} cones covers"
    most = "the one slice there" if found.slices == 1 else f"the best of {found.slices} slices there"
    return (
        f"at ({x:.2f}, {y:.2f}) it holds the heading {round(np.degrees(heading)) % 360}°, but {most}, "
        f"{found.width:.2f} m wide, loses the headings {spoken(*found.lost)}"
    )
