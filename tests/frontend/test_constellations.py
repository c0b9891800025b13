from itertools import combinations
from typing import Any

import numpy as np
import pytest

from frontend.constellations import consistent, constellations, largest_clique
from frontend.rigid_motion import transform


def random_graph(seed: int, n: int = 14, density: float = 0.5) -> Any:
    upper = np.triu(np.random.default_rng(seed).random((n, n)) < density, 1)
    return upper | upper.T


def is_clique(graph: Any, members: Any) -> Any:
    return all(graph[i, j] for i, j in combinations(members, 2))


@pytest.mark.parametrize("seed", range(8))
def test_no_larger_clique_exists(seed: int) -> None:
    graph = random_graph(seed)
    clique = largest_clique(graph)
    assert is_clique(graph, clique)
    assert not any(is_clique(graph, members) for members in combinations(range(14), len(clique) + 1))


@pytest.mark.parametrize("seed", range(4))
def test_every_pair_is_in_the_largest_constellation_around_it(seed: int) -> None:
    graph = random_graph(seed, 10)
    found = constellations(graph)
    for vertex in range(10):
        largest = max(len(c) for c in found if vertex in c)
        around = [m for m in combinations(range(10), largest + 1) if vertex in m]
        assert not any(is_clique(graph, members) for members in around)


def test_a_graph_without_pairs_has_no_constellation() -> None:
    assert largest_clique(np.zeros((0, 0), dtype=bool)).size == 0


def test_pairs_of_one_motion_are_consistent_and_a_stray_is_not() -> None:
    rng = np.random.default_rng(0)
    b, pose = rng.uniform(-3, 3, (6, 2)), np.array([1.0, 2.0, 0.7])
    a = transform(b, pose)
    a[5] += [1.0, 1.0]
    graph = consistent(a, b, np.full(6, 0.7), 0.1, 0.2)
    assert graph[:5, :5].all()
    assert not graph[5, :5].any()


def test_a_mirrored_constellation_is_not_consistent() -> None:
    b = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]])
    graph = consistent(b * [1, -1], b, np.zeros(3), 0.1, 0.2)
    assert not graph[1, 2]
