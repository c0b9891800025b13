"""Which landmark an arc is, and where that puts the robot."""

from dataclasses import replace

import numpy as np

from backend.arc_association import AssociationSettings, Belief, Known, associate
from tests.backend.test_arcs import arcs_of

CORNER = [Known(True, 3, -2.0, 2.0, 0.0), Known(True, 6, -2.0, 2.0, 0.0)]


def belief(doubt: float, *walls: tuple[float, float, float]) -> Belief:
    mean = np.array([0.0, 0.0, 0.0, *np.array(walls).ravel()])
    covariance = np.diag([doubt**2, doubt**2, (doubt / 2) ** 2] + [1e-6] * (len(mean) - 3))
    return Belief(mean, covariance)


def test_two_walls_put_the_robot_where_it_is() -> None:
    before = belief(0.1, (2.0, 0.0, 0.0), (0.0, 1.5, np.pi / 2))
    arcs = arcs_of((1.9, -0.02, 0.02), (1.55, np.pi / 2 - 0.02, 0.02))
    placed = associate(before, CORNER, arcs, AssociationSettings())
    assert sorted(placed.pairs) == [(0, 0), (1, 1)]
    assert np.allclose(placed.pose, [0.1, -0.05, 0.02], atol=0.015)
    assert np.all(np.diag(placed.covariance) < np.diag(before.covariance)[:3])


def test_an_arc_between_two_walls_that_explain_it_alike_ties_nothing() -> None:
    before = belief(0.2, (2.0, 0.0, 0.0), (2.1, 0.0, 0.0))
    placed = associate(before, CORNER, arcs_of((2.05, 0.0, 0.02)), AssociationSettings())
    assert not placed.pairs
    assert not placed.loose


def test_what_nothing_explains_is_loose_and_a_wall_ends_where_it_was_seen_to_end() -> None:
    before = belief(0.02, (2.0, 5.0, 0.0))
    placed = associate(before, [Known(True, 3, -1.0, 1.0, 0.0)], arcs_of((2.0, 0.0, 0.02)), AssociationSettings())
    assert placed.loose == (0,)
    assert np.allclose(placed.pose, 0)


def test_what_may_be_an_edge_is_a_wall_only_where_the_wall_was_seen() -> None:
    before, arcs = belief(0.02, (2.0, 5.6, 0.0)), arcs_of((2.0, 0.0, 0.02))
    soft = replace(arcs, firm=np.zeros(1, bool))
    wall = [Known(True, 3, -5.0, 5.0, 0.0)]  # it ends 0.6 m beside the foot, but a firm arc shows half a metre of it
    assert associate(before, wall, arcs, AssociationSettings()).pairs == ((0, 0),)
    assert associate(before, wall, soft, AssociationSettings()).loose == (0,)


def test_an_edge_is_not_met_from_its_other_side() -> None:
    before, arcs = belief(0.05), arcs_of((1.0, 0.0, 0.05))
    before = Belief(np.append(before.mean, [1.0, 0.0]), np.diag([*np.diag(before.covariance), 1e-4, 1e-4]))
    for ray, pairs in ((0.5, ((0, 0),)), (2.5, ())):
        assert associate(before, [Known(False, 3, 0.0, 0.0, ray)], arcs, AssociationSettings()).pairs == pairs
