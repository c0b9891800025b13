"""A Voronoi roadmap for discs, as a reference: shortest ways on the medial axis of sampled walls."""

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import Voronoi, cKDTree

from planners.world import World

Floats = NDArray[np.float64]


def voronoi_ways(world: World, radius: float, queries: list[dict[str, Any]]) -> list[dict[str, float]]:
    """Length over the optimum, and clearance in radii, of the way along the medial axis for every query it solves."""
    samples = shapely.get_coordinates(shapely.segmentize(world.free.boundary, radius / 5))
    diagram, tree = Voronoi(samples), cKDTree(samples)
    ridges = np.array([ridge for ridge in diagram.ridge_vertices if min(ridge) >= 0])
    rooms = np.asarray(tree.query(diagram.vertices)[0])
    inner = shapely.contains_xy(world.free, diagram.vertices) & (rooms > radius)
    ridges = ridges[inner[ridges].all(axis=1)]
    ends = diagram.vertices[ridges]
    ridges = ridges[tree.query(ends.mean(axis=1))[0] > radius]
    lengths = np.linalg.norm(np.diff(diagram.vertices[ridges], axis=1)[:, 0], axis=1)
    total = len(diagram.vertices)
    graph = csr_array((lengths, (ridges[:, 0], ridges[:, 1])), shape=(total, total))
    used = np.unique(ridges)
    ways = (_way(query, (graph, diagram.vertices, rooms, used), radius) for query in queries)
    return [way for way in ways if np.isfinite(way["ratio"])]


def _way(
    query: dict[str, Any], roadmap: tuple[Any, Floats, Floats, NDArray[np.int64]], radius: float
) -> dict[str, float]:
    graph, vertices, rooms, used = roadmap
    near = [used[np.argmin(np.linalg.norm(vertices[used] - query[end], axis=1))] for end in ("start", "goal")]
    distances, before = dijkstra(graph, directed=False, indices=near[0], return_predecessors=True)
    ends = sum(np.linalg.norm(vertices[node] - query[end]) for node, end in zip(near, ("start", "goal"), strict=True))
    clearance, node = rooms[near[1]], near[1]
    while np.isfinite(distances[near[1]]) and node != near[0]:
        node = before[node]
        clearance = min(clearance, rooms[node])
    return {"ratio": float((distances[near[1]] + ends) / query["shortest"]), "clearance": float(clearance / radius)}
