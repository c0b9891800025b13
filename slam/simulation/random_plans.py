"""Random furnished floors: a rectangle split into rooms by 10 cm walls, joined by doors, with things in them."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import shapely
from shapely import LineString, Polygon, box
from shapely.affinity import rotate

from frontend.scan import Floats
from slam.simulation.floors import Plan, drive_along, ell, feature, pillar, plan_of, walls_around

WALL = 0.1
Gap = tuple[int, int, LineString]


@dataclass(frozen=True)
class FloorRules:
    """What a random floor looks like; metres."""

    narrowest_room: float = 2.4
    door_widths: tuple[float, float] = (0.75, 1.0)
    extra_doors: float = 0.3  # chance of a door in a wall that connectivity does not need: more loops
    things_per_room: float = 5.0  # mean of the tries, about a third find room; more clutter
    lane: float = 0.5  # half-width kept free along the drive; more elbow room
    step: float = 0.9  # between scans


def random_plan(seed: int, rooms: int, rules: FloorRules | None = None) -> Plan:
    """A floor of `rooms` rooms (3…12) with doors, obstacles and a drive through all; the same for the same seed."""
    if not 3 <= rooms <= 12:
        raise ValueError(f"a random floor has 3 to 12 rooms, not {rooms}")
    rules = rules or FloorRules()
    rng = np.random.default_rng([seed, rooms])
    width = np.sqrt(rooms * rng.uniform(12, 18) * rng.uniform(1.0, 1.6))
    whole = (0.0, 0.0, round(width, 2), round(rooms * 15.0 / width, 2))
    boxes = [box(*corners) for corners in _split(whole, rooms, rules, rng)]
    gaps = list(_doors(boxes, rules, rng))
    tour = _tour(boxes, gaps)
    lanes = LineString(tour).buffer(rules.lane)
    named = {f"room {number}": room for number, room in enumerate(boxes)}
    doors = {f"door {first}-{second}": line for first, second, line in gaps}
    things = [thing for room in boxes for thing in _furniture(room, lanes, rules, rng)]
    drive = drive_along(tour, step=rules.step)
    return plan_of(f"random {seed}", f"{rooms} random rooms", [*walls_around(named, doors, WALL), *things, drive])


Corners = tuple[float, float, float, float]


def _split(whole: Corners, rooms: int, rules: FloorRules, rng: np.random.Generator) -> list[Corners]:
    """Split the largest room across its longer side until there are enough."""
    pieces = [whole]
    while len(pieces) < rooms:
        largest = max(pieces, key=lambda c: (c[2] - c[0]) * (c[3] - c[1]))
        pieces.remove(largest)
        left, bottom, right, top = largest
        upright = right - left > top - bottom
        low, high = (left, right) if upright else (bottom, top)
        share = rng.uniform(0.4, 0.6)
        cut = low + max(rules.narrowest_room, round(share * (high - low), 2))
        pieces += (
            [(left, bottom, cut - WALL / 2, top), (cut + WALL / 2, bottom, right, top)]
            if upright
            else [(left, bottom, right, cut - WALL / 2), (left, cut + WALL / 2, right, top)]
        )
    return pieces


def _doors(rooms: list[Polygon], rules: FloorRules, rng: np.random.Generator) -> Iterator[Gap]:
    """A door in every wall of a random spanning tree, and in some of the others."""
    shared = [
        (first, second, _shared_wall(rooms[first], rooms[second]))
        for first, second in combinations(range(len(rooms)), 2)
    ]
    walls = [(first, second, wall) for first, second, wall in shared if wall is not None]
    group = list(range(len(rooms)))
    for index in rng.permutation(len(walls)):
        first, second, wall = walls[index]
        needed = group[first] != group[second]
        if needed or rng.random() < rules.extra_doors:
            group = [group[first] if member == group[second] else member for member in group]
            yield first, second, _opening(wall, rules, rng)


def _shared_wall(first: Polygon, second: Polygon) -> LineString | None:
    """The middle line of the wall between two rooms where it is long enough for a door."""
    strip = first.buffer(WALL, join_style="mitre").intersection(second.buffer(WALL, join_style="mitre"))
    left, bottom, right, top = strip.bounds if not strip.is_empty else (0.0, 0.0, 0.0, 0.0)
    if max(right - left, top - bottom) < 1.8 or min(right - left, top - bottom) > 1.5 * WALL:
        return None
    x, y = (left + right) / 2, (bottom + top) / 2
    return LineString([(x, bottom), (x, top)] if top - bottom > right - left else [(left, y), (right, y)])


def _opening(wall: LineString, rules: FloorRules, rng: np.random.Generator) -> LineString:
    half = rng.uniform(*rules.door_widths) / 2
    middle = rng.uniform(half + 0.35, wall.length - half - 0.35)
    return LineString([wall.interpolate(middle - half), wall.interpolate(middle + half)])


def _tour(rooms: list[Polygon], gaps: list[Gap]) -> list[tuple[float, float]]:
    """Depth first through every room and back, straight between the rooms' middles and the doors."""
    visited: set[int] = set()

    def walk(room: int) -> Iterator[tuple[float, float]]:
        visited.add(room)
        middle = rooms[room].centroid
        yield middle.x, middle.y
        for first, second, line in gaps:
            beyond = second if room == first else first
            if room in (first, second) and beyond not in visited:
                door = line.centroid
                through = _through(rooms[room], line), _through(rooms[beyond], line)
                yield from (
                    through[0],
                    (door.x, door.y),
                    through[1],
                    *walk(beyond),
                    through[1],
                    (door.x, door.y),
                    through[0],
                )
                yield middle.x, middle.y

    return list(walk(0))


def _through(room: Polygon, line: LineString) -> tuple[float, float]:
    """A place half a metre inside a room, straight in front of its door."""
    door, deep = line.centroid, room.buffer(-0.5, join_style="mitre")
    ahead = shapely.shortest_line(door, deep)
    x, y = ahead.coords[-1]
    return x, y


def _furniture(room: Polygon, lanes: Polygon, rules: FloorRules, rng: np.random.Generator) -> Iterator[Plan]:
    """Boxes, turned boxes, L-shapes and round things, where the drive leaves them room and they don't touch."""
    taken = [lanes]
    left, bottom, right, top = room.bounds
    for _ in range(rng.poisson(rules.things_per_room)):
        place = rng.uniform((left, bottom), (right, top))
        shape, thing = _thing(place, rng)
        apart = all(shape.distance(other) > 0.1 for other in taken)
        if apart and room.buffer(-0.02).contains(shape):
            taken.append(shape)
            yield thing


def _thing(place: Floats, rng: np.random.Generator) -> tuple[Polygon, Plan]:
    (x, y), sizes = place, rng.uniform(0.3, 1.2, 2)
    kind = rng.integers(4)
    if kind == 0:
        round_thing = pillar((x, y), sizes[0] / 3)
        return Polygon(round_thing["geometry"]["coordinates"][0]), round_thing
    if kind == 1:
        shape = ell((x, y), rng.choice([0, 90, 180, 270]), sizes[0] + 0.3, 0.25)
    else:
        shape = box(x - sizes[0] / 2, y - sizes[1] / 2, x + sizes[0] / 2, y + sizes[1] / 2)
        shape = rotate(shape, rng.uniform(0, 90)) if kind == 2 else shape
    return shape, feature(shape, "obstacle", material="rough")
