"""Worlds whose answers are known: a door of any width, a corridor that bends, and the shared ones where they are."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from shapely import Polygon, box

from planners.robot import Robot
from planners.world import World

Floats = NDArray[np.float64]

LONG = Robot.rectangle(20.0, 8.0)
CRITICAL_CORNER = 12.728  # the width of both arms at which a 20 x 8 rectangle just turns the corner: 9 · √2


def door(width: float) -> World:
    """Two rooms of 43 x 60, joined by a passage 14 long in the middle."""
    low, high = 30 - width / 2, 30 + width / 2
    return World.from_obstacles(box(0, 0, 100, 60), [box(43, 0, 57, low), box(43, high, 57, 60)])


def corner(width: float) -> World:
    """A corridor of one width along the bottom and up the right side."""
    return World.from_obstacles(box(0, 0, 60, 60), [box(0, width, 60 - width, 60)])


def diagonal() -> World:
    """Two rooms of 32 x 32 that overlap in a square of 4 x 4: the only way is across its corners."""
    return World.from_obstacles(box(0, 0, 60, 60), [box(0, 0, 28, 28), box(32, 32, 60, 60)])


def corner_query(width: float) -> tuple[Floats, Floats]:
    """From the left end to the top end."""
    return np.array([12.0, width / 2, 0.0]), np.array([60 - width / 2, 48.0, np.pi / 2])


def shared_worlds() -> dict[str, Any]:
    """The worlds beside the data folder; skips without it."""
    path = Path(os.environ.get("ROOMSKETCH_DATA", "absent")) / ".." / "benchmarks" / "planner_worlds.json"
    if not path.exists():
        pytest.skip("ROOMSKETCH_DATA names no folder with ../benchmarks/planner_worlds.json beside it")
    worlds: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return worlds


def world_of(record: dict[str, Any]) -> World:
    """One of the shared worlds."""
    return World.from_obstacles(box(*record["bounds"]), [Polygon(corners) for corners in record["polygons"]])
