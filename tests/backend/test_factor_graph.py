"""The factor graph: exact where all agrees, robust where a loop lies, and honest about what it does not know."""

from collections.abc import Callable

import numpy as np
import pytest

from backend.factor_graph import FactorGraph, GraphError, GraphSettings
from frontend.rigid_motion import between, compose, inverse, transform, wrap
from frontend.scan import Floats

STEP = np.diag([0.02, 0.02, 0.01]) ** 2
LOOP = np.diag([0.01, 0.01, 0.005]) ** 2
FIRM = np.diag([1e-3, 1e-3, 1e-4]) ** 2


def twice_round(count: int = 40) -> Floats:
    """Poses (n, 3) twice round a circle of 4 m."""
    angles = np.linspace(0, 4 * np.pi, count, endpoint=False)
    return np.column_stack([4 * np.cos(angles), 4 * np.sin(angles), wrap(angles + np.pi / 2)])


def noisy(move: Floats, covariance: Floats, rng: np.random.Generator) -> Floats:
    return compose(move, rng.multivariate_normal(np.zeros(3), covariance))


def chained(true: Floats, rng: np.random.Generator | None = None) -> FactorGraph:
    """A graph of successive motions, each noisy where a generator is given, started by dead reckoning."""
    graph = FactorGraph(GraphSettings())
    graph.add_pose(0, true[0])
    graph.anchor(0, true[0], FIRM)
    reckoned = true[0]
    for k in range(1, len(true)):
        exact = between(true[k - 1], true[k])
        move = exact if rng is None else noisy(exact, STEP, rng)
        reckoned = compose(reckoned, move)
        graph.add_pose(k, reckoned)
        graph.add_motion(k - 1, k, move, STEP)
    return graph


def worst(graph: FactorGraph, true: Floats) -> float:
    return float(np.max(np.linalg.norm(graph.poses[:, :2] - true[:, :2], axis=1)))


def closed(true: Floats, rng: np.random.Generator) -> FactorGraph:
    """The same with loops between the first and the second round."""
    graph, half = chained(true, rng), len(true) // 2
    for k in range(half):
        graph.add_loop(k, half + k, noisy(between(true[k], true[half + k]), LOOP, rng), LOOP)
    return graph


def test_exact_motions_give_exact_poses() -> None:
    true = twice_round()
    graph = chained(true)
    graph.solve()
    assert worst(graph, true) < 1e-6


def test_loops_take_the_drift_out() -> None:
    true = twice_round()
    graph = closed(true, np.random.default_rng(0))
    before = worst(graph, true)
    graph.solve()
    assert worst(graph, true) < 0.5 * before


def test_a_false_loop_among_true_ones_loses_its_weight() -> None:
    """Without it the answer is the same to a centimetre; as a motion, which is always believed, it tears the map."""
    true, false = twice_round(), compose(between(twice_round()[3], twice_round()[33]), np.array([1.5, -1.0, 0.6]))
    answers = []
    for add_false in (lambda graph: None, lambda graph: graph.add_loop(3, 33, false, LOOP),
                      lambda graph: graph.add_motion(3, 33, false, LOOP)):  # fmt: skip
        graph = closed(true, np.random.default_rng(1))
        add_false(graph)
        graph.solve()
        answers.append(graph.poses)
    without, doubted, believed = answers
    assert np.max(np.linalg.norm((doubted - without)[:, :2], axis=1)) < 0.01
    assert np.max(np.linalg.norm((believed - without)[:, :2], axis=1)) > 0.3


def test_many_false_loops_do_not_outvote_the_true_ones() -> None:
    true, rng = twice_round(), np.random.default_rng(2)
    graph = closed(true, rng)
    without = closed(true, np.random.default_rng(2))
    for _ in range(10):
        fixed, moving = np.sort(rng.choice(len(true), 2, replace=False))
        graph.add_loop(int(fixed), int(moving), np.array([*rng.uniform(-3, 3, 2), rng.uniform(-3, 3)]), LOOP)
    graph.solve()
    without.solve()
    assert worst(graph, true) < worst(without, true) + 0.03


def test_the_residuals_name_the_false_loop() -> None:
    true = twice_round()
    graph = closed(true, np.random.default_rng(3))
    graph.add_loop(5, 30, compose(between(true[5], true[30]), np.array([1.0, 0, 0])), LOOP)
    graph.solve()
    residuals = graph.loop_residuals()
    assert max(residuals, key=lambda loop: loop[2])[:2] == (5, 30)
    assert max(sigmas for _, _, sigmas in residuals) > 20
    assert np.median([sigmas for _, _, sigmas in residuals]) < 2.5


def test_the_covariance_of_an_open_chain_grows_and_a_loop_makes_it_small_again() -> None:
    true = np.column_stack([np.arange(20.0), np.zeros(20), np.zeros(20)])
    graph = chained(true)
    graph.solve()
    sizes = [np.trace(covariance[:2, :2]) for covariance in graph.covariances()]
    assert np.all(np.diff(sizes) > 0)
    graph.add_loop(0, 19, true[19], LOOP)
    graph.solve()
    assert np.trace(graph.covariances()[19][:2, :2]) < 0.1 * sizes[19]


def test_along_a_straight_chain_the_covariance_is_the_sum_of_its_steps() -> None:
    """On a line of n steps the variance along it is the sum, and each heading swings all that comes after it."""
    count = 10
    graph = chained(np.column_stack([np.arange(count + 1.0), np.zeros((count + 1, 2))]))
    graph.solve()
    covariance = graph.covariances()[-1]
    swing = np.sum(np.arange(count) ** 2) * STEP[2, 2]
    lever = FIRM[2, 2] * count**2
    assert covariance[0, 0] == pytest.approx(count * STEP[0, 0] + FIRM[0, 0], rel=1e-3)
    assert covariance[1, 1] == pytest.approx(count * STEP[1, 1] + swing + FIRM[1, 1] + lever, rel=1e-3)
    assert covariance[2, 2] == pytest.approx(count * STEP[2, 2] + FIRM[2, 2], rel=1e-3)


def test_errors_are_within_the_covariance() -> None:
    """Over noise draws the mean squared error in units of the covariance is that of χ² with 3 degrees of freedom."""
    true, squares = twice_round(20), []
    for seed in range(60):
        graph = chained(true, np.random.default_rng(seed))
        graph.solve()
        error = between(true[-1], graph.poses[-1])
        squares.append(error @ np.linalg.solve(graph.covariances()[-1], error))
    assert np.mean(squares) / 3 == pytest.approx(1, abs=0.35)


def test_covariances_are_in_each_poses_own_axes() -> None:
    """The same chain laid in another direction has the same covariances."""
    true = np.column_stack([np.arange(5.0), np.zeros(5), np.zeros(5)])
    turned = np.array([compose(np.array([3.0, 1.0, 2.0]), pose) for pose in true])
    first, second = chained(true), chained(turned)
    first.solve()
    second.solve()
    np.testing.assert_allclose(first.covariances()[1:], second.covariances()[1:], atol=1e-7)


def test_landmarks_seen_from_many_poses_tie_them() -> None:
    true, rng = twice_round(), np.random.default_rng(4)
    landmarks = np.array([[0.0, 0.0], [6.0, 1.0], [-5.0, 3.0], [1.0, -6.0]])
    spread = np.diag([0.02, 0.02]) ** 2
    loose, tied = chained(true, np.random.default_rng(5)), chained(true, np.random.default_rng(5))
    for number, place in enumerate(landmarks):
        tied.add_landmark(number, place + rng.normal(0, 0.2, 2))
    for k, pose in enumerate(true):
        for number, place in enumerate(transform(landmarks, inverse(pose))):
            tied.add_sighting(k, number, place + rng.normal(0, 0.02, 2), spread)
    loose.solve()
    tied.solve()
    assert worst(tied, true) < 0.5 * worst(loose, true)
    assert np.max(np.linalg.norm(tied.landmarks - landmarks, axis=1)) < 0.06


def test_a_wrong_sighting_moves_nothing_much() -> None:
    true = twice_round()
    graph = chained(true)
    graph.add_landmark(0, np.zeros(2))
    for k, pose in enumerate(true):
        graph.add_sighting(k, 0, transform(np.zeros((1, 2)), inverse(pose))[0], np.diag([0.02, 0.02]) ** 2)
    graph.add_sighting(7, 0, np.array([5.0, 5.0]), np.diag([0.02, 0.02]) ** 2)
    graph.solve()
    assert worst(graph, true) < 0.03


def test_poses_and_landmarks_come_back_in_the_order_they_were_added() -> None:
    graph = FactorGraph(GraphSettings())
    for index in (4, 1, 9):
        graph.add_pose(index, np.array([index, 0.0, 0.1]))
        graph.add_landmark(index, np.array([0.0, index]))
    np.testing.assert_allclose(graph.poses[:, 0], [4, 1, 9])
    np.testing.assert_allclose(graph.landmarks[:, 1], [4, 1, 9])
    assert graph.landmark_indices == [4, 1, 9]


def test_an_empty_graph_has_empty_arrays() -> None:
    graph = FactorGraph(GraphSettings())
    assert graph.poses.shape == (0, 3)
    assert graph.landmarks.shape == (0, 2)
    assert graph.loop_residuals() == []


@pytest.mark.parametrize(
    ("factor", "says"),
    [
        (lambda graph: graph.add_motion(0, 7, np.zeros(3), STEP), "names pose 7, but the graph holds 3 poses"),
        (lambda graph: graph.add_loop(8, 0, np.zeros(3), STEP), "names pose 8"),
        (lambda graph: graph.anchor(9, np.zeros(3), STEP), "names pose 9"),
        (lambda graph: graph.add_sighting(6, 0, np.ones(2), np.eye(2)), "names pose 6"),
        (lambda graph: graph.add_sighting(0, 5, np.ones(2), np.eye(2)), "landmark 5, but the graph holds 0 landmarks"),
    ],
)
def test_a_factor_of_what_the_graph_does_not_hold_is_an_error_that_names_it(
    factor: Callable[[FactorGraph], None], says: str
) -> None:
    with pytest.raises(GraphError, match=says):
        factor(chained(twice_round(3)))


def test_after_a_refused_factor_the_graph_still_solves() -> None:
    true = twice_round(5)
    graph = chained(true)
    with pytest.raises(GraphError):
        graph.add_loop(0, 70, np.zeros(3), LOOP)
    graph.solve()
    assert worst(graph, true) < 1e-6
    assert graph.loop_residuals() == []


def test_a_wall_seen_twice_ties_the_way_towards_it_and_not_along_it() -> None:
    graph = FactorGraph(GraphSettings())
    for k in range(2):
        graph.add_pose(k, np.array([0.5 * k, 0.1 * k, 0.0]))
    graph.anchor(0, np.zeros(3), np.eye(3) * 1e-8)
    graph.add_motion(0, 1, np.array([0.5, 0.1, 0.0]), np.diag([0.1, 0.1, 0.01]) ** 2)
    graph.add_wall(0, np.array([2.0, 0.0, 0.0]))
    for k, distance in enumerate((2.0, 1.6)):
        graph.add_wall_sighting(k, 0, np.array([distance, -0.1 * k, 0.0]), np.diag([1e-4, 1e4, 1e-4]))
    graph.solve()
    assert np.allclose(graph.poses[1, :2], [0.4, 0.1], atol=0.01)
    assert np.allclose(graph.walls, [[2.0, 0.0, 0.0]], atol=1e-3)
    mean, covariance = graph.belief(1, [0], [])
    assert np.allclose(mean[:3], graph.poses[1])
    assert np.sqrt(covariance[0, 0]) < 0.02
    assert np.sqrt(covariance[1, 1]) > 0.09


def test_a_carried_part_keeps_its_shape_and_then_hangs_on_what_ties_it() -> None:
    """Two chains with their own anchors; the second, with landmark and wall, is laid on the first and tied there."""
    true = twice_round(12)
    carry = np.array([30.0, -5.0, 1.0])
    graph = chained(true[:6])
    for k in range(6, 12):
        graph.add_pose(k, compose(carry, true[k]))
        if k == 6:
            graph.anchor(6, compose(carry, true[6]), FIRM)
        else:
            graph.add_motion(k - 1, k, between(true[k - 1], true[k]), STEP)
    graph.add_landmark(0, transform(np.array([[1.0, 1.0]]), carry)[0])
    for k in (7, 8):
        seen = transform(np.array([[1.0, 1.0]]), inverse(true[k]))[0]
        graph.add_sighting(k, 0, seen, np.diag([0.02, 0.02]) ** 2)
    wall = np.array([6.0, 0.5, 0.2])
    graph.add_wall(0, compose(carry, wall))
    for k in (7, 8):
        graph.add_wall_sighting(k, 0, between(true[k], wall), np.diag([1e-4, 1e4, 1e-4]))
    graph.solve()
    graph.carry({k: compose(inverse(carry), pose) for k, pose in enumerate(graph.poses) if k >= 6}, freed=6)
    np.testing.assert_allclose(graph.landmarks[0], [1, 1], atol=1e-3)
    np.testing.assert_allclose(graph.walls[0], wall, atol=1e-3)
    graph.add_loop(5, 6, between(true[5], true[6]), LOOP)
    graph.mend()
    graph.solve()
    assert worst(graph, true) < 1e-3
    np.testing.assert_allclose(graph.walls[0], wall, atol=1e-3)


def test_a_landmark_at_the_robots_own_place_is_refused() -> None:
    graph = chained(twice_round(3))
    graph.add_landmark(0, np.zeros(2))
    with pytest.raises(GraphError, match="landmark 0 is seen where pose 1 stands"):
        graph.add_sighting(1, 0, np.zeros(2), np.eye(2))


def test_without_an_anchor_nothing_is_known_of_where_poses_are() -> None:
    graph = FactorGraph(GraphSettings())
    graph.add_pose(0, np.zeros(3))
    with pytest.raises(GraphError, match="1 poses, but no anchor"):
        graph.covariances()


def test_a_finer_end_goes_on_where_a_coarser_one_stopped() -> None:
    true = twice_round()
    coarse, fine = (chained(true, np.random.default_rng(1)) for _ in range(2))
    for graph in (coarse, fine):
        for k in range(20, len(true)):
            graph.add_loop(k - 20, k, between(true[k - 20], true[k]), LOOP)
    coarse.solve(0.5)
    fine.solve(1e-9)
    assert np.abs(coarse.poses - fine.poses).max() > 1e-3
    coarse.solve(1e-9)
    assert np.allclose(coarse.poses, fine.poses, atol=1e-4)


def test_a_loop_far_off_holds_once_it_was_taken_at_its_word() -> None:
    """Forty sure steps and a loop ten doubts away: the robust kernel alone leaves it half open."""
    graph = FactorGraph(GraphSettings())
    graph.add_pose(0, np.zeros(3))
    graph.anchor(0, np.zeros(3), np.eye(3) * 1e-6)
    for k in range(1, 41):
        graph.add_pose(k, np.array([0.1 * k, 0, 0]))
        graph.add_motion(k - 1, k, np.array([0.1, 0, 0]), np.diag([0.15, 0.15, 0.02]) ** 2)
    for k in (36, 40):
        graph.add_loop(0, k, np.array([0.1 * (k - 40), 0, 0]), np.diag([0.01, 0.01, 0.005]) ** 2)
    assert graph.solved().poses[-1, 0] > 1.0
    graph.believe(2)
    graph.solve()
    assert abs(graph.poses[-1, 0]) < 0.05


def test_what_is_one_is_put_into_one_line_and_one_place() -> None:
    graph, seen = FactorGraph(GraphSettings()), np.diag([0.01, 0.01, 0.01]) ** 2
    graph.add_pose(0, np.zeros(3))
    graph.anchor(0, np.zeros(3), np.eye(3) * 1e-10)
    for k, off in enumerate((0.0, 0.02)):
        frame = np.array([2.0 + off, 3.0 * k, off])
        graph.add_wall(k, frame)
        graph.add_wall_sighting(0, k, frame, seen)
        graph.add_landmark(k, np.array([1.0 + off, 1.0]))
        graph.add_sighting(0, k, np.array([1.0 + off, 1.0]), seen[:2, :2])
    graph.unite_walls(0, 1)
    graph.unite_landmarks(0, 1)
    graph.solve(1e-9)
    (first, second), normal = graph.walls, np.array([np.cos(graph.walls[0, 2]), np.sin(graph.walls[0, 2])])
    assert first[2] == pytest.approx(second[2], abs=2e-3)
    assert (second - first)[:2] @ normal == pytest.approx(0.0, abs=2e-3)
    assert graph.landmarks[0] == pytest.approx(graph.landmarks[1], abs=2e-3)
    assert graph.landmarks[:, 0].mean() == pytest.approx(1.01, abs=1e-3)
