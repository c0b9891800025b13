"""What poses by sonar and infrared owe to each piece of the method: drives again, with one piece left out.

The settings are those of every other drive, but for that piece. The floors played no part in its choice.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from slam.settings import Settings, knowing
from tests.benchmarks.sonar_poses import Drive, apartment, floor, judged, row

FLOORS = (21, 22)
Row = dict[str, Any]

ARCS = Settings().poses.arcs
FRONTEND = Settings().frontend
WHOLE_TURN = 2 * np.pi


def arcs_with(**changes: Any) -> Settings:
    """Settings with some fields of the tracking by arcs changed."""
    return replace(Settings(), poses=replace(Settings().poses, arcs=replace(ARCS, **changes)))


def landmarks_with(**changes: Any) -> Settings:
    """Settings with some fields of the arcs' landmarks changed."""
    return arcs_with(landmarks=replace(ARCS.landmarks, **changes))


NO_WALLS = replace(FRONTEND, arcs=replace(FRONTEND.arcs, firm=WHOLE_TURN, rising=WHOLE_TURN))
ALL_ROUND = {
    "births": replace(ARCS.landmarks.births, facing=WHOLE_TURN),
    "association": replace(ARCS.landmarks.association, facing=WHOLE_TURN),
}
# What is left out, and how.
PIECES: tuple[tuple[str, Settings], ...] = (
    ("walls as landmarks", replace(Settings(), frontend=NO_WALLS)),
    ("edges as landmarks", landmarks_with(births=replace(ARCS.landmarks.births, facing=0.0))),
    ("edges having a side", landmarks_with(**ALL_ROUND)),
    ("walls standing square", landmarks_with(square=replace(ARCS.landmarks.square, sightings=10**9))),
    ("doubled landmarks united", landmarks_with(doubles=replace(ARCS.landmarks.doubles, evidence=np.inf))),
    ("loops", landmarks_with(revisits=10**9)),
    ("the outline's first guess", arcs_with(matched=2.0)),
    ("solving to the end", arcs_with(settled=Settings().poses.graph.settled)),
)


def rows() -> list[Row]:
    """One row per piece: the mean error of the drives without it, beside that with it."""
    drives = [apartment(), *map(floor, FLOORS)]
    whole = [judged(drive).error for drive in drives]
    found = [piece_row(name, drives, settings, whole) for name, settings in PIECES]
    unknown = [judged(drive, Settings()).error for drive in drives]
    return [*found, compared("the recording's word on its wheels", unknown, whole)]


def piece_row(name: str, drives: list[Drive], settings: Settings, whole: list[float]) -> Row:
    """The drives mapped without one piece."""
    errors = [judged(drive, knowing(settings, drive.wheels)).error for drive in drives]
    return compared(name, errors, whole)


def compared(name: str, errors: list[float], whole: list[float]) -> Row:
    """Errors of some drives without a piece, and of the same with all."""
    listed = ", ".join(f"{error:.3f} ({known:.3f})" for error, known in zip(errors, whole, strict=True))
    note = f"what the piece is worth; apartment and {len(FLOORS)} random floors, with it in brackets: {listed}"
    mean = float(np.mean(errors))
    return row(f"sonar, without {name}: mean ATE", mean, "m", None, {"with it": float(np.mean(whole))}, note)
