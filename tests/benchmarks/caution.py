"""The cones' caution on worlds that it was not chosen on: how long ways are, and how much room is left.

The drawn floors lie in the folder that ROOMSKETCH_DATA names.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from planners.generalized_cones import ConesSettings, prepare, query
from planners.robot import Robot
from planners.visibility import eroded, roadmap_of, shortest
from planners.world import World
from tests.backend.plan_rays import furnished_plan
from tests.benchmarks.merging_cases import FLOORS, floor_case
from tests.benchmarks.row import Row
from tests.planners.random_worlds import random_world

Floats = NDArray[np.float64]
CAUTIONS = (0.0, 0.5, 1.0, 2.0, 4.0)
WAYS = 8  # in every world


class Place(NamedTuple):
    """A world, the radius of a disc in it, ends (w, 2, 2) of ways, and the least length (w,) of each."""

    kind: str
    world: World
    radius: float
    ends: Floats
    least: Floats


def rows() -> list[Row]:
    """One row per figure. Raises KeyError without the folder of drawn floors."""
    places = list(worlds())
    return [
        row
        for caution in CAUTIONS
        for kind in dict.fromkeys(place.kind for place in places)
        for row in rows_of(kind, [place for place in places if place.kind == kind], caution)
    ]


def rows_of(kind: str, places: list[Place], caution: float) -> list[Row]:
    """Medians of the length over the shortest way, and of the least room from the disc's middle, in radii."""
    found = np.array([way for place in places for way in ways(place, caution)])
    asked = sum(len(place.ends) for place in places)
    note = f"{len(found)} of {asked} ways found; 90 % are under {np.percentile(found[:, 0], 90):.2f}"
    return [
        _row(f"{kind}, caution {caution:g}: length", float(np.median(found[:, 0])), "", "lower", note),
        _row(f"{kind}, caution {caution:g}: least room", float(np.median(found[:, 1])), "radii", "higher", ""),
    ]


def worlds() -> Iterator[Place]:
    """Furnished plans, drawn floors and random obstacles, each with a robot and ways of its own."""
    for seed in range(14):
        rng = np.random.default_rng(52000 + seed)
        yield _place(
            "furnished plans", World.from_free_space(furnished_plan(rng, 4 + seed % 8).free), rng, (0.12, 0.28)
        )
    for floor in FLOORS[:5]:
        world = World.from_free_space(floor_case(floor).plan.free)
        yield _place("drawn floors", world, np.random.default_rng(floor), (0.12, 0.28))
    for seed in range(12):
        rng = np.random.default_rng(63000 + seed)
        yield _place("random obstacles", random_world(rng), rng, (1.0, 2.5))


def ways(place: Place, caution: float) -> Iterator[tuple[float, float]]:
    """Of every way that is found its length over the least, and the least room beside it in radii."""
    cones = prepare(place.world, Robot.disc(place.radius), replace(ConesSettings(), caution=caution))
    for ends, least in zip(place.ends, place.least, strict=True):
        path = query(cones, np.array([*ends[0], 0.0]), np.array([*ends[1], 0.0])).path
        if path is not None:
            yield path.length / least, 1 + path.clearance / place.radius


def _place(kind: str, world: World, rng: np.random.Generator, radii: tuple[float, float]) -> Place:
    radius = float(rng.uniform(*radii))
    room = max(eroded(world.free, 1.05 * radius), key=lambda part: part.area)
    low, high = np.reshape(room.bounds, (2, 2))
    ends: list[Floats] = []
    while len(ends) < WAYS:
        pair = rng.uniform(low, high, (2, 2))
        far = np.linalg.norm(pair[0] - pair[1]) > 0.3 * np.linalg.norm(high - low)
        if far and shapely.contains_xy(room, *pair.T).all():
            ends.append(pair)
    roadmap = roadmap_of(world, radius)
    shortest_ways = [shortest(roadmap, *pair) for pair in ends]
    least = [float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum()) for way in shortest_ways if way is not None]
    return Place(kind, world, radius, np.array(ends), np.array(least))


def _row(name: str, value: float, unit: str, better: str, note: str) -> Row:
    return {
        "part": "caution", "name": name, "value": value, "unit": unit, "better": better,
        "target": None, "peers": {}, "runs": 1, "note": note,
    }  # fmt: skip
