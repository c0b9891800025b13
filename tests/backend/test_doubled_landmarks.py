"""Landmarks that were born twice are found by what is believed of all of them together."""

import numpy as np
import pytest

from backend.arc_association import Belief, Known
from backend.doubled_landmarks import DoubleSettings, doubled

SETTINGS = DoubleSettings()
PLACES = np.array([[1.0, 0.0], [2.0, 1.5], [0.0, 3.0]])
RAYS = (0.0, 0.6, 1.6)


def revisited(drift: np.ndarray, sure: float, born: float = 0.01) -> tuple[Belief, list[Known]]:
    """Three edges, and the same again as a robot sees them that has drifted by (3,), within `sure` metres and radians.

    born: metres to which either set is known in itself.
    """
    mean = [np.zeros(3), *PLACES, *(PLACES + drift[:2] + drift[2] * np.column_stack([-PLACES[:, 1], PLACES[:, 0]]))]
    slope = np.vstack([np.eye(3), np.zeros((6, 3)), *(np.array([[1, 0, -y], [0, 1, x]]) for x, y in PLACES)])
    covariance = slope @ slope.T * sure**2 + np.eye(len(slope)) * born**2
    known = [Known(False, 3 + 2 * k, 0.0, 0.0, RAYS[k % 3]) for k in range(6)]
    return Belief(np.concatenate(mean), covariance), known


def united(belief: Belief, known: list[Known], pairs: list[tuple[int, int]]) -> tuple[tuple[int, int], ...]:
    found = doubled(belief, known, pairs, SETTINGS)
    return found.pairs if found is not None and found.one else ()


ALL = [(elder, younger) for elder in range(3) for younger in range(3, 6)]


def test_edges_that_one_drift_explains_are_the_same() -> None:
    found = united(*revisited(np.array([0.3, -0.2, 0.05]), 0.2), ALL)
    assert sorted(found) == [(0, 3), (1, 4), (2, 5)]


def test_no_drift_explains_edges_that_moved_apart() -> None:
    belief, known = revisited(np.array([0.3, -0.2, 0.05]), 0.2)
    belief.mean[[9, 11, 13]] += [0.3, -0.3, 0.3]
    belief.mean[[10, 12, 14]] += [-0.3, 0.3, 0.3]
    assert united(belief, known, ALL) == ()


def test_what_is_known_sharply_and_lies_apart_is_two() -> None:
    assert united(*revisited(np.array([0.15, 0.0, 0.0]), 0.005), ALL) == ()


def test_one_edge_within_a_wide_doubt_is_no_evidence() -> None:
    found = doubled(*revisited(np.array([0.1, 0.0, 0.0]), 0.5), [(0, 3)], SETTINGS)
    assert found is not None
    assert not found.one
    assert found.reason.endswith(": under 3.0 it may be chance")


def test_one_edge_found_again_within_a_tight_doubt_is_the_same() -> None:
    assert united(*revisited(np.array([0.01, 0.0, 0.0]), 0.01), [(0, 3)]) == ((0, 3),)


def test_of_two_that_may_be_its_double_neither_is_taken() -> None:
    belief, known = revisited(np.zeros(3), 0.02)
    belief.mean[5:7] = belief.mean[3:5] + 0.01
    known[1] = known[1]._replace(ray=0.0)
    found = doubled(belief, known, [(0, 3), (1, 3)], SETTINGS)
    assert found is not None
    assert not found.one
    assert "another answer has" in found.reason


def test_an_edge_met_from_the_other_side_is_another() -> None:
    belief, known = revisited(np.zeros(3), 0.01)
    known[3] = known[3]._replace(ray=np.pi)
    assert united(belief, known, [(0, 3)]) == ()


def walls(offset: float, turn: float, gap: float) -> tuple[Belief, list[Known]]:
    """Two walls along y, seen over 2 m each with a gap between; the second lies off by a way across and a turn."""
    mean = np.array([0, 0, 0, 3.0, 0, 0, 3.0 + offset, 2 + gap, turn])
    known = [Known(True, 3, 0.0, 2.0, 0.0), Known(True, 6, 0.0, 2.0, 0.0)]
    return Belief(mean, np.diag([1e-4] * 3 + [1e-4, 1.0, 1e-4] * 2)), known


@pytest.mark.parametrize(
    ("offset", "turn", "gap", "same"),
    [(0.01, 0.01, 0.1, True), (0.2, 0.0, 0.1, False), (0.0, 0.2, 0.1, False), (0.01, 0.01, 1.0, False)],
)
def test_a_wall_is_the_same_in_line_and_near_by(offset: float, turn: float, gap: float, same: bool) -> None:
    assert bool(united(*walls(offset, turn, gap), [(0, 1)])) == same


def test_faces_of_opposite_sides_are_never_one() -> None:
    assert united(*walls(0.0, np.pi, 0.1), [(0, 1)]) == ()
