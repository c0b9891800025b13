"""Chains: pieces of a path along spines with the arcs of legal headings on them, and the motion that they become."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planners.entrances import AT_FOOT, COST, CROSSED, FOOT, LEG, NODE
from planners.headings import Arc, least_turning
from planners.slices import Body
from planners.spine_graph import SpineGraph
from planners.spine_search import Route
from planners.way_in import STEPS, common, departures, standing_arcs

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


def _arc(row: Floats, begin: int) -> Arc:
    return float(row[begin]), float(row[begin + 1])


def _held(pose: Floats, arc: Arc) -> Arc:
    """The heading of a pose (3,) as an arc; where any will do, all those of `arc`."""
    return (float(pose[2]), float(pose[2])) if np.isfinite(pose[2]) else arc


def _departed(row: Floats, pose: Floats, target: Floats, cost: float) -> Chain:
    """The straight way of a row of `way_in.departures` from a pose (3,) to a target (2,)."""
    here, turned, first, leg = (_arc(row, begin) for begin in range(0, STEPS - 2, 2))
    return Chain((pose[:2], pose[:2], pose[:2], target), (_held(pose, here), turned, leg), (here, first), cost)


def straight(body: Body, begin: Floats, end: Floats) -> Chain | None:
    """The straight way between two poses (3,), if some heading is legal all along it."""
    ways, cost = departures(body, standing_arcs(body, begin), np.concatenate([begin[:2], end[:2]]))
    there = standing_arcs(body, end)
    for row in ways:
        for arrived in common(row[None, STEPS - 2 :].copy(), there):
            way, here = _departed(row, begin, end[:2], cost), _arc(arrived, 4)
            points = (*way.points, end[:2], end[:2])
            return Chain(
                points, (*way.legs, _arc(arrived, 0), _held(end, here)), (*way.turns, _arc(arrived, 2), here), cost
            )
    return None


def entered(graph: SpineGraph, row: Floats, pose: Floats) -> Chain:
    """The way in of a row of `entrances` from a pose (3,) to the row's node."""
    foot, stop = row[FOOT : FOOT + 2], graph.stop_points[graph.node_stop[int(row[NODE])]]
    way = _departed(row, pose, foot, float(row[COST]))
    turns = (*way.turns, _arc(row, STEPS - 2), _arc(row, AT_FOOT))
    return Chain((*way.points, foot, stop), (*way.legs, _arc(row, CROSSED), _arc(row, LEG)), turns, way.cost)


def threaded(graph: SpineGraph, first: Chain, found: Route, last: Chain) -> Chain:
    """The way in, the route through the graph, and the way out."""
    between = graph.stop_points[graph.node_stop[found.nodes[1:]]]
    legs: list[Arc] = [(low, high) for low, high in graph.edge_arcs[found.edges].tolist()]
    turns: list[Arc] = [(low, high) for low, high in graph.arcs[found.nodes].tolist()]
    cost = first.cost + float(graph.costs[found.edges].sum()) + last.cost
    points = (*first.points, *between, *last.points[1:])
    return Chain(points, (*first.legs, *legs, *last.legs), (*first.turns, *turns, *last.turns), cost)


def motion_of(chain: Chain) -> Floats:
    """The motion (p, 3): along every leg at its heading, turning on the spot between legs."""
    headings = least_turning(chain.legs, chain.turns)
    points = np.array(chain.points)
    poses = np.concatenate([np.column_stack([points[:-1], headings]), np.column_stack([points[1:], headings])], axis=1)
    flat = poses.reshape(-1, 3)
    moved = np.concatenate([[True], np.abs(np.diff(flat, axis=0)).max(axis=1) > 0])
    return _without_waypoints(flat[moved])


def _without_waypoints(poses: Floats) -> Floats:
    """Poses (k, 3) without those at which neither the direction nor the heading changes."""
    moves = np.diff(poses, axis=0)
    units = moves / np.linalg.norm(moves, axis=1, keepdims=True)
    bends = np.abs(np.diff(units, axis=0)).max(axis=1, initial=0) > 1e-9
    return np.asarray(poses[np.concatenate([[True], bends, [True]])] if len(poses) > 1 else poses)
