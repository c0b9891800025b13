"""A* over the graph of spines, from the nodes that the start reaches to those from which the goal is reached.

What is left to go is bounded from below by landmarks (ALT: Goldberg & Harrelson 2005): no way is shorter than the
difference of its ends' distances from any third node.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from planners.compiled import compiled, kernel
from planners.spine_graph import SpineGraph
from planners.state_queue import Queue, pop, push, queue_for

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

LANDMARKS = 16  # larger searches fewer nodes and takes longer to prepare
SLACK = 0.05  # share by which a way may cost more than the cheapest; larger searches fewer nodes


class Route(NamedTuple):
    """Edges (r,) of the graph in order, their nodes (r + 1,), and which nodes (n,) the search closed."""

    edges: Ints
    nodes: Ints
    closed: NDArray[np.bool_]


@kernel
def _left(landmarks: Floats, node: int, span: Floats) -> float:
    """What is left from a node, by at most SLACK too much.

    landmarks (n, l): distances; span (2, l): least and greatest of those of the goal.
    """
    most = 0.0
    for k in range(span.shape[1]):
        most = max(most, landmarks[node, k] - span[1, k], span[0, k] - landmarks[node, k])
    return most * (1 + SLACK)


@compiled
def _search(
    graph: SpineGraph, entry: Floats, leave: Floats, landmarks: Floats, span: Floats, queue: Queue
) -> tuple[int, Ints, Ints, Floats]:
    """Last node (−1: none), and for every node the edge and node it was reached by, and its distance if closed."""
    total = entry.size
    cost, closed = entry.copy(), np.full(total, np.inf)
    by_edge, by_node = np.full(total, -1, np.int32), np.full(total, -1, np.int32)
    best, last = np.inf, -1
    for node in range(total):
        if np.isfinite(entry[node]):
            push(queue, node, cost[node] + _left(landmarks, node, span))
    while queue.size[0] > 0:
        node = pop(queue)
        closed[node] = cost[node]
        if queue.key[node] >= best:
            break
        if cost[node] + leave[node] < best:
            best, last = cost[node] + leave[node], node
        for edge in range(graph.first_edge[node], graph.first_edge[node + 1]):
            target = graph.targets[edge]
            reached = cost[node] + graph.costs[edge]
            if reached < cost[target] and np.isinf(closed[target]):
                cost[target], by_edge[target], by_node[target] = reached, edge, node
                push(queue, target, reached + _left(landmarks, target, span))
    return last, by_edge, by_node, closed


def landmarks_of(graph: SpineGraph) -> Floats:
    """Distances (n, l) of all nodes from a few that lie far apart in the largest connected part; 0 in other parts."""
    total = len(graph.arcs)
    if not len(graph.targets):
        return np.zeros((total, 0))
    joints = csr_array((np.ones(len(graph.targets)), graph.targets, graph.first_edge), shape=(total, total))
    parts = connected_components(joints, directed=False)[1]
    here = int(np.argmax(parts == np.bincount(parts).argmax()))
    distances = np.zeros((total, LANDMARKS))
    nearest = _distances_from(graph, here)
    for k in range(LANDMARKS):
        here = int(np.argmax(nearest))
        distances[:, k] = _distances_from(graph, here)
        nearest = distances[:, k] if k == 0 else np.minimum(nearest, distances[:, k])
    return distances


def _distances_from(graph: SpineGraph, node: int) -> Floats:
    total = len(graph.arcs)
    entry, nowhere = np.full(total, np.inf), np.full(total, np.inf)
    entry[node] = 0.0
    closed = _search(graph, entry, nowhere, np.zeros((total, 0)), np.zeros((2, 0)), queue_for(total))[3]
    return np.asarray(np.where(np.isfinite(closed), closed, 0.0))


def route(graph: SpineGraph, landmarks: Floats, entry: Floats, leave: Floats) -> Route | NDArray[np.bool_]:
    """The cheapest way through the graph, or one that costs SLACK more; without one, which nodes (n,) can be reached.

    entry, leave: (n,) metres from the start to a node and from it to the goal, inf where there is no way.
    """
    exits, span = np.flatnonzero(np.isfinite(leave)), np.zeros((2, 0))
    if len(exits):
        around, left = landmarks[exits], leave[exits, None]
        span = np.stack([(around + left).min(axis=0), (around - left).max(axis=0)])
    last, by_edge, by_node, closed = _search(graph, entry, leave, landmarks, span, queue_for(len(entry)))
    if last < 0:
        return np.asarray(np.isfinite(closed))
    edges: list[int] = []
    nodes = [last]
    while by_edge[nodes[-1]] >= 0:
        edges.append(int(by_edge[nodes[-1]]))
        nodes.append(int(by_node[nodes[-1]]))
    return Route(np.array(edges[::-1], np.int32), np.array(nodes[::-1], np.int32), np.isfinite(closed))
