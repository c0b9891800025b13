from itertools import combinations, pairwise

import numpy as np
import pytest
from shapely import Polygon

from frontend.best_polylines import Polylines, best_polylines, cheapest_chains, chord_costs, settled
from frontend.scan import Booleans, Floats
from tests.benchmarks.likely_polylines import maximum_likelihood
from tests.benchmarks.polylines import radial_errors
from tests.frontend.rooms import FURNISHED, L_ROOM, lidar_scan


def rays_of(room: Polygon, n: int = 90) -> tuple[Floats, Booleans]:
    scan = lidar_scan(room, np.array([1.0, 1.5, 0.2]), n, seed=0)
    rays = scan.ranges[:, None] * np.column_stack([np.cos(scan.bearings), np.sin(scan.bearings)])
    return rays, np.append(np.hypot(*np.diff(rays, axis=0).T) < 1.0, False)


def likelihood_cost(rays: Floats, lines: Polylines, undrawn: float) -> float:
    errors = radial_errors(rays, lines)
    return float(np.nansum(errors**2) + undrawn**2 * np.sum(np.isnan(errors)))


def test_the_chosen_rays_are_the_best_there_are() -> None:
    rays, _ = rays_of(FURNISHED, 18)
    joined = np.append(np.ones(17, dtype=bool), False)
    costs = chord_costs(rays, joined, 0.09)
    undrawn = 0.09

    def cost(chain: tuple[int, ...]) -> float:  # one line, or two, over the rays of the chain
        one = np.sum([costs[i, j] for i, j in pairwise(chain)]) + undrawn * (17 - chain[-1] + chain[0])
        a, b, c, d = chain
        two = costs[a, b] + costs[c, d] + undrawn * (a + c - b - 1 + 17 - d)
        return float(min(one, two))

    chosen, last = cheapest_chains(costs, 4, undrawn)
    lines = Polylines(rays[chosen], chosen, ~last)
    assert likelihood_cost(rays, lines, 0.3) == pytest.approx(min(map(cost, combinations(range(18), 4))))


@pytest.mark.parametrize("count", [6, 10, 20])
@pytest.mark.parametrize("room", [L_ROOM, FURNISHED])
def test_it_is_hardly_ever_less_likely_than_what_greedy_removal_leaves(room: Polygon, count: int) -> None:
    rays, joined = rays_of(room)
    ours = likelihood_cost(rays, best_polylines(rays, joined, count, 0.5), 0.5)
    assert ours <= likelihood_cost(rays, maximum_likelihood(rays, joined, count), 0.5) * 1.05


def test_moving_the_vertices_only_helps_and_keeps_the_rays_drawn() -> None:
    rays, joined = rays_of(FURNISHED)
    chosen, last = cheapest_chains(chord_costs(rays, joined, 0.25), 12, 0.25)
    before = radial_errors(rays, Polylines(rays[chosen], chosen, ~last))
    after = radial_errors(rays, Polylines(settled(rays, chosen, last), chosen, ~last))
    assert np.array_equal(np.isnan(before), np.isnan(after))
    assert np.nansum(after**2) < np.nansum(before**2)


def test_no_line_crosses_a_gap() -> None:
    rays, _ = rays_of(L_ROOM)
    joined = np.arange(90) % 30 != 29
    lines = best_polylines(rays, joined, 12, 0.5)
    crossed = lines.rays[:-1][lines.joined[:-1]] // 30 != lines.rays[1:][lines.joined[:-1]] // 30
    assert not np.any(crossed)


def test_with_few_vertices_the_dearest_rays_stay_undrawn() -> None:
    rays, joined = rays_of(FURNISHED)
    drawn = [np.mean(~np.isnan(radial_errors(rays, best_polylines(rays, joined, n, 0.2)))) for n in (4, 12, 30)]
    assert drawn == sorted(drawn)
    assert drawn[0] < 0.8 < drawn[2]
