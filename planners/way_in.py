"""Ways from a pose to the spines: straight to the nearest point of a spine, then along it to the next crossings."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planners.circular import joined, shared
from planners.compiled import compiled
from planners.headings import Arc
from planners.orientations import intersected, legal_along, nearest
from planners.slices import Body, Slices
from planners.spine_graph import SpineGraph, rows_at, run_between

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Chain:
    """A piece of a path: points (k + 1) with a leg's arc between successive ones, and the arcs to turn in between.

    cost: metres, more where it is tight.
    """

    points: tuple[Floats, ...]
    legs: tuple[Arc, ...]
    turns: tuple[Arc, ...]
    cost: float

    def reversed(self) -> "Chain":
        """The same piece the other way."""
        return Chain(self.points[::-1], self.legs[::-1], self.turns[::-1], self.cost)


@compiled
def _way(body: Body, piece: Floats) -> tuple[Floats, Floats, Floats]:
    """Legal arcs all along a piece (4,), on its first and on its last slice."""
    total = max(1, int(np.ceil(np.hypot(piece[2] - piece[0], piece[3] - piece[1]) / body.step)))
    part = np.empty(4)
    everywhere = first = last = np.empty((0, 2))
    for each in range(total):
        for axis in range(2):
            rise = piece[2 + axis] - piece[axis]
            part[axis] = piece[axis] + rise * each / total
            part[2 + axis] = piece[axis] + rise * (each + 1) / total
        last = legal_along(body.polar, body.radius, part, body.ends, body.margin)
        everywhere = last if each == 0 else intersected(everywhere, last)
        if each == 0:
            first = last
        if everywhere.shape[0] == 0:
            break
    return joined(everywhere), joined(first), joined(last)


@compiled
def _cost(body: Body, piece: Floats) -> float:
    """Length of a piece (4,), times up to 1 + caution where it is tight."""
    room = body.width
    low_x, high_x = min(piece[0], piece[2]) - room, max(piece[0], piece[2]) + room
    low_y, high_y = min(piece[1], piece[3]) - room, max(piece[1], piece[3]) + room
    for k in range(body.ends.shape[0]):
        wall = body.ends[k]
        if min(wall[0], wall[2]) > high_x or max(wall[0], wall[2]) < low_x:
            continue
        if min(wall[1], wall[3]) > high_y or max(wall[1], wall[3]) < low_y:
            continue
        room = min(room, nearest(piece, wall)[2])
    tightness = min(max(2 - 2 * room / body.width, 0.0), 1.0)
    return float(np.hypot(piece[2] - piece[0], piece[3] - piece[1]) * (1 + body.caution * tightness))


def way(body: Body, begin: Floats, end: Floats) -> tuple[Floats, Floats, Floats]:
    """Legal arcs all along the straight piece between two points, on its first and on its last slice."""
    return _way(body, np.concatenate([begin, end]))


def common(first: Floats, second: Floats) -> Iterator[tuple[Arc, Arc, Arc]]:
    """Every arc shared by an arc of the first set and one of the second, with those two."""
    both = np.empty((2, 2))
    for one in first:
        for two in second:
            for k in range(shared(one[0], one[1], two[0], two[1], both)):
                yield (float(both[k, 0]), float(both[k, 1])), (one[0], one[1]), (two[0], two[1])


def departures(body: Body, pose: Floats, target: Floats) -> Iterator[tuple[Chain, Arc]]:
    """Ways from `pose` (3,) straight to the point `target` (2,), each with the arc at its end.

    The robot first turns on the spot to a heading that is legal all the way.
    """
    here = way(body, pose[:2], pose[:2])[0]
    if np.isfinite(pose[2]):
        here = np.array([arc for arc in here if (pose[2] - arc[0]) % (2 * np.pi) <= arc[1] - arc[0]]).reshape(-1, 2)
    along, first, last = way(body, pose[:2], target)
    standing = (float(pose[2]), float(pose[2]))
    cost = _cost(body, np.concatenate([pose[:2], target]))
    for turned, arc_here, arc_first in common(here, first):
        for leg, _, _ in common(along, np.array([arc_first])):
            for _, arc_last, _ in common(last, np.array([leg])):
                begin = standing if np.isfinite(pose[2]) else arc_here
                points = (pose[:2], pose[:2], pose[:2], target)
                yield Chain(points, (begin, turned, leg), (arc_here, arc_first), cost), arc_last


def _feet(slices: Slices, point: Floats) -> tuple[Floats, Floats, Floats]:
    """Nearest point (k, 2) of every spine, its place 0 … 1 and its distance."""
    begin, end = slices.pieces[slices.first[:-1], :2], slices.pieces[slices.first[1:] - 1, 2:]
    along = end - begin
    places = np.clip(np.einsum("ij,ij->i", point - begin, along) / np.einsum("ij,ij->i", along, along), 0, 1)
    feet = begin + places[:, None] * along
    return feet, places, np.linalg.norm(feet - point, axis=1)


def entrances(body: Body, slices: Slices, graph: SpineGraph, pose: Floats, most: int) -> Iterator[tuple[int, Chain]]:
    """Nodes that a pose (3,) reaches, with the way, by the `most` nearest spines."""
    feet, places, distances = _feet(slices, pose[:2])
    for cone in np.argsort(distances)[:most]:
        row = int(rows_at(slices, np.array([cone]), places[[cone]])[0])
        stops = np.arange(graph.first_stop[cone], graph.first_stop[cone + 1])
        after = stops[graph.stops[stops, 1] >= places[cone]][:1]
        before = stops[graph.stops[stops, 1] < places[cone]][-1:]
        at_foot = joined(slices.legal[row, : slices.counts[row]])
        for chain, arrived in departures(body, pose, feet[cone]):
            for crossed, _, arc_foot in common(np.array([arrived]), at_foot):
                for stop in (*before, *after):
                    yield from _along(body, slices, graph, (chain, arrived, crossed, arc_foot), (row, int(stop)))


def _along(
    body: Body, slices: Slices, graph: SpineGraph, foot: tuple[Chain, Arc, Arc, Arc], ends: tuple[int, int]
) -> Iterator[tuple[int, Chain]]:
    """From the foot along its spine to a stop: every arc that is legal between, and the node it leads to."""
    (chain, arrived, crossed, arc_foot), (row, stop) = foot, ends
    other = int(graph.stops[stop, 2])
    legal = run_between(slices, min(row, other), max(row, other))
    nodes = slice(graph.first_node[stop], graph.first_node[stop + 1])
    cost = chain.cost + _cost(body, np.concatenate([chain.points[-1], graph.stop_points[stop]]))
    for leg, _, _ in common(legal, np.array([arc_foot])):
        for _, arc_node, _ in common(graph.arcs[nodes], np.array([leg])):
            node = int(graph.first_node[stop] + np.flatnonzero((graph.arcs[nodes] == arc_node).all(axis=1))[0])
            points = (*chain.points, chain.points[-1], graph.stop_points[stop])
            yield node, Chain(points, (*chain.legs, crossed, leg), (*chain.turns, arrived, arc_foot), cost)
