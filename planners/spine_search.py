"""A* over the graph of spines, from the nodes that the start reaches to those from which the goal is reached."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.compiled import compiled
from planners.spine_graph import SpineGraph
from planners.state_queue import Queue, pop, push, queue_for

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


class Route(NamedTuple):
    """Edges (r,) of the graph in order, their nodes (r + 1,), and which nodes (n,) the search closed."""

    edges: Ints
    nodes: Ints
    closed: NDArray[np.bool_]


@compiled
def _search(
    graph: SpineGraph, entry: Floats, leave: Floats, goal: Floats, queue: Queue
) -> tuple[int, Ints, Ints, Ints]:
    """Last node (−1: none), and for every node the edge and node it was reached by, and whether it was closed."""
    total = entry.size
    cost = entry.copy()
    by_edge, by_node, closed = np.full(total, -1, np.int32), np.full(total, -1, np.int32), np.zeros(total, np.int32)
    best, last = np.inf, -1
    for node in range(total):
        if np.isfinite(entry[node]):
            point = graph.stop_points[graph.node_stop[node]]
            push(queue, node, cost[node] + np.hypot(point[0] - goal[0], point[1] - goal[1]))
    while queue.size[0] > 0:
        node = pop(queue)
        closed[node] = 1
        if queue.key[node] >= best:
            break
        if cost[node] + leave[node] < best:
            best, last = cost[node] + leave[node], node
        for edge in range(graph.first_edge[node], graph.first_edge[node + 1]):
            target = graph.targets[edge]
            reached = cost[node] + graph.costs[edge]
            if closed[target] == 0 and reached < cost[target]:
                cost[target], by_edge[target], by_node[target] = reached, edge, node
                point = graph.stop_points[graph.node_stop[target]]
                push(queue, target, reached + np.hypot(point[0] - goal[0], point[1] - goal[1]))
    return last, by_edge, by_node, closed


def route(graph: SpineGraph, entry: Floats, leave: Floats, goal: Floats) -> Route | NDArray[np.bool_]:
    """The shortest way through the graph; without one, which nodes (n,) can be reached.

    entry, leave: (n,) metres from the start to a node and from it to the goal, inf where there is no way.
    """
    last, by_edge, by_node, closed = _search(graph, entry, leave, goal, queue_for(len(entry)))
    if last < 0:
        return closed.astype(bool)
    edges: list[int] = []
    nodes = [last]
    while by_edge[nodes[-1]] >= 0:
        edges.append(int(by_edge[nodes[-1]]))
        nodes.append(int(by_node[nodes[-1]]))
    return Route(np.array(edges[::-1], np.int32), np.array(nodes[::-1], np.int32), closed.astype(bool))
