"""Shortest paths of a disc on merged maps, beside the true plan's: do they cut through walls, how long are they."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, MultiPolygon
from shapely.geometry.base import BaseGeometry

from planners.box_space import ConfigurationSpaceSettings
from planners.disc_space import DiscSpace, prepare_disc, query_disc
from planners.robot import parse_robot
from planners.world import World

Floats = NDArray[np.float64]
RADIUS = 0.15
INSET = (
    0.05  # metres the safety layer keeps off: places that seen ground does not join so far off walls are not asked for
)
PAIRS = 12  # starts and goals per map


@dataclass(frozen=True)
class Paths:
    """asked: pairs joined by seen ground; found: of these on the map; through: that cut a true wall.

    lengths: of those found, over the true plan's.
    """

    asked: int
    found: int
    through: int
    lengths: tuple[float, ...]


def paths_on(layer: MultiPolygon, true_free: BaseGeometry, seen: BaseGeometry, rng: np.random.Generator) -> Paths:
    """Paths between random places of seen ground on a map's layer, against the same robot's on the true plan."""
    places = _places(seen.buffer(-RADIUS - 0.15), 2 * PAIRS, rng)
    ours, truth = _space(layer), _space(_polygons(true_free))
    joined = _space(_polygons(seen.buffer(-INSET, join_style="mitre")))
    asked = found = through = 0
    lengths = []
    for start, goal in zip(places[::2], places[1::2], strict=True):
        exact = _shortest(truth, start, goal)
        if exact is None or _shortest(joined, start, goal) is None:
            continue
        asked += 1
        path = _shortest(ours, start, goal)
        if path is not None:
            found += 1
            through += not shapely.covers(true_free, path)
            lengths.append(path.length / exact.length)
    return Paths(asked, found, through, tuple(lengths))


def _polygons(shape: BaseGeometry) -> MultiPolygon:
    return MultiPolygon(list(shapely.get_parts(shape)))


def _space(free: MultiPolygon) -> DiscSpace:
    return prepare_disc(World.from_free_space(free), parse_robot(f"disc:{RADIUS}"), ConfigurationSpaceSettings())


def _shortest(space: DiscSpace, start: Floats, goal: Floats) -> LineString | None:
    answer = query_disc(space, np.array([*start, np.nan]), np.array([*goal, np.nan]))
    return None if answer.path is None else LineString(answer.path.poses[:, :2])


def _places(ground: BaseGeometry, count: int, rng: np.random.Generator) -> Floats:
    x0, y0, x1, y1 = ground.bounds
    shapely.prepare(ground)
    places = np.empty((0, 2))
    while len(places) < count:
        tried = rng.uniform((x0, y0), (x1, y1), (256, 2))
        places = np.concatenate([places, tried[shapely.contains_xy(ground, tried[:, 0], tried[:, 1])]])
    return places[:count]
