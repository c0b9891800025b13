"""What walls and edges at believed places answer, and how that changes with what is believed."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.arcs import Arcs, seen_edge, seen_wall

NUMBERS = st.floats(-2, 2)


def arcs_of(*rows: tuple[float, float, float]) -> Arcs:
    """Arcs of range, bearing and its spread, each as a firm wall and as an edge alike."""
    ranges, bearings, spreads = np.array(rows, float).reshape(-1, 3).T
    ends, sure = np.full(len(rows), 0.5), np.ones(len(rows), bool)
    return Arcs(ranges, 0.01, bearings, spreads, -ends, ends, bearings, spreads, sure, sure)


@settings(deadline=None, max_examples=20)
@given(NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS)
def test_the_derivatives_are_those_of_differences(
    x: float, y: float, turn: float, along: float, heading: float
) -> None:
    state = np.array([x, y, turn, x + 3 * np.cos(heading), y + 3 * np.sin(heading), heading + along / 5])
    _, slope, _ = seen_wall(state[:3], state[3:])
    _, edge_slope = seen_edge(state[:3], state[3:5])
    for k in range(6):
        step = np.zeros(6)
        step[k] = 1e-6
        ahead, behind = (seen_wall((state + s)[:3], (state + s)[3:])[0] for s in (step, -step))
        assert np.allclose(np.angle(np.exp(1j * (ahead - behind))) / 2e-6, slope[:, k], atol=1e-4)
        if k < 5:
            ahead, behind = (seen_edge((state + s)[:3], (state + s)[3:5])[0] for s in (step, -step))
            assert np.allclose(np.angle(np.exp(1j * (ahead - behind))) / 2e-6, edge_slope[:, k], atol=1e-4)


def test_a_sighted_wall_lies_at_its_foot_wherever_its_origin_is() -> None:
    arcs = arcs_of((2.0, 0.3, 0.02))
    frame, covariance = arcs.sighted_wall(0, 1.5)
    seen, _, along = seen_wall(np.zeros(3), frame)
    assert np.allclose(seen, [2.0, 0.3])
    assert np.isclose(along, 1.5)
    # A bearing that errs swings the origin about the foot.
    turned, _ = arcs_of((2.0, 0.31, 0.02)).sighted_wall(0, 1.5)
    across = np.cos(0.3) * (turned - frame)[0] + np.sin(0.3) * (turned - frame)[1]
    assert np.isclose(across, covariance[0, 2] / covariance[2, 2] * 0.01, atol=2e-4) or np.isclose(
        -across, covariance[0, 2] / covariance[2, 2] * 0.01, atol=2e-4
    )


def test_a_sighted_edge_is_sure_along_its_ray() -> None:
    place, covariance = arcs_of((2.0, np.pi / 2, 0.1)).sighted_edge(0)
    assert np.allclose(place, [0, 2])
    assert np.allclose(covariance, np.diag([0.04, 1e-4]))
