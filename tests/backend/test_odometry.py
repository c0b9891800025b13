"""Odometry: the filter learns a robot's constants from registered moves, and lets slips teach it nothing."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2

from backend.odometry import Move, Odometry, OdometrySettings
from frontend.rigid_motion import between, compose
from frontend.scan import Floats

SETTINGS = OdometrySettings()
REGISTERED = np.diag([0.004, 0.004, 0.002]) ** 2
# Metres per metre, radians per radian, radians per metre, mount forward and left.
ROBOTS = (
    np.array([1.0, 1.0, 0.0, 0.0, 0.0]),
    np.array([0.93, 1.08, 0.04, 0.12, -0.05]),
    np.array([1.1, 0.9, -0.06, -0.08, 0.1]),
)


def driven_arc(way: float, turn: float) -> Floats:
    """The chord (3,) of an arc of this length and turn."""
    chord = way * np.sinc(turn / (2 * np.pi))
    return np.array([chord * np.cos(turn / 2), chord * np.sin(turn / 2), turn])


def simulated_moves(constants: Floats, count: int, rng: np.random.Generator) -> list[tuple[Floats, Floats]]:
    """What the wheels claim (3,), and how the registered point, off the centre of turning, truly moved (3,)."""
    scale, turn_scale, bias, *mount = constants
    moves = []
    for _ in range(count):
        way, turn = float(rng.uniform(0, 0.6)), float(rng.normal(0, 0.3))
        noise = rng.normal(0, 1, 2) * [0.02 * way + 0.002, 0.02 * abs(turn) + 0.01 * way + 0.001]
        centre = driven_arc(scale * way + noise[0], turn_scale * turn + bias * way + noise[1])
        lever = np.array([*mount, 0.0])
        moves.append((driven_arc(way, turn), between(lever, compose(centre, lever))))
    return moves


def taught(constants: Floats, count: int, seed: int) -> Odometry:
    rng = np.random.default_rng(seed)
    odometry = Odometry(SETTINGS)
    for wheels, moved in simulated_moves(constants, count, rng):
        seen = moved + rng.multivariate_normal(np.zeros(3), REGISTERED)
        odometry.learn(wheels, Move(seen, REGISTERED))
    return odometry


def test_before_anything_is_learnt_the_wheels_are_believed() -> None:
    wheels = np.array([0.5, 0.1, 0.3])
    np.testing.assert_allclose(Odometry(SETTINGS).predict(wheels).pose, wheels)


@pytest.mark.parametrize("constants", ROBOTS)
def test_scales_unnoticed_turn_and_mount_are_learnt_from_simulated_moves(constants: Floats) -> None:
    learnt = np.mean([taught(constants, 300, seed).calibration for seed in range(5)], axis=0)
    np.testing.assert_allclose(learnt, constants, atol=0.012)


@pytest.mark.parametrize("constants", ROBOTS)
def test_the_stated_spread_of_the_constants_is_not_too_small(constants: Floats) -> None:
    runs = [taught(constants, 150, seed) for seed in range(20)]
    sigmas = np.array([(run.calibration - constants) / run.calibration_spread for run in runs])
    assert np.all(np.sum(sigmas**2, axis=0) < chi2.ppf(0.999, len(runs)))


def test_learning_only_ever_makes_the_constants_surer() -> None:
    rng = np.random.default_rng(0)
    odometry = Odometry(SETTINGS)
    spreads = [odometry.calibration_spread]
    for wheels, moved in simulated_moves(ROBOTS[1], 50, rng):
        odometry.learn(wheels, Move(moved, REGISTERED))
        spreads.append(odometry.calibration_spread)
    assert np.all(np.diff(spreads, axis=0) <= 1e-12)
    assert np.all(spreads[-1] < spreads[0])


def test_after_learning_moves_are_predicted_better_than_the_wheels_claim_them() -> None:
    odometry = taught(ROBOTS[1], 200, 1)
    moves = simulated_moves(ROBOTS[1], 200, np.random.default_rng(99))
    predicted = np.array([odometry.predict(wheels).pose - moved for wheels, moved in moves])
    claimed = np.array([wheels - moved for wheels, moved in moves])
    assert np.all(np.std(predicted, axis=0) < 0.6 * np.std(claimed, axis=0))


def test_predictions_are_within_their_covariance() -> None:
    odometry = taught(ROBOTS[1], 100, 2)
    moves = simulated_moves(ROBOTS[1], 200, np.random.default_rng(98))
    squares = []
    for wheels, moved in moves:
        predicted = odometry.predict(wheels)
        error = predicted.pose - moved
        squares.append(error @ np.linalg.solve(predicted.covariance, error))
    assert np.sum(squares) < chi2.ppf(0.999, 3 * len(squares))


def test_doubt_grows_with_the_way_and_with_the_turn_and_is_never_nothing() -> None:
    odometry = Odometry(SETTINGS)
    standing, driving, farther, turning = (
        odometry.predict(np.array(wheels, float)).covariance
        for wheels in ((0, 0, 0), (0.3, 0, 0), (0.9, 0, 0), (0.3, 0, 1.0))
    )
    assert np.all(np.linalg.eigvalsh(standing) > 0)
    assert np.all(np.diag(driving) > np.diag(standing))
    assert np.all(np.diag(farther) > np.diag(driving))
    assert turning[2, 2] > driving[2, 2]


@pytest.mark.parametrize("slipped", [(0.3, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.4)])
def test_a_slip_is_flagged_and_teaches_nothing(slipped: tuple[float, float, float]) -> None:
    odometry = taught(ROBOTS[1], 200, 3)
    calibration, spread = odometry.calibration, odometry.calibration_spread
    wheels = np.array([0.4, 0.0, 0.1])
    moved = odometry.predict(wheels).pose
    assert odometry.learn(wheels, Move(moved + slipped, REGISTERED)) > SETTINGS.slip_gate
    np.testing.assert_array_equal(odometry.calibration, calibration)
    np.testing.assert_array_equal(odometry.calibration_spread, spread)


def test_true_moves_are_seldom_called_slips() -> None:
    odometry = taught(ROBOTS[2], 100, 4)
    rng = np.random.default_rng(97)
    distances = [
        odometry.learn(wheels, Move(moved, REGISTERED)) for wheels, moved in simulated_moves(ROBOTS[2], 300, rng)
    ]
    assert np.mean(np.array(distances) > SETTINGS.slip_gate) < 0.01


def test_one_slip_in_ten_does_not_spoil_what_is_learnt() -> None:
    rng = np.random.default_rng(5)
    odometry = Odometry(SETTINGS)
    flags = []
    for number, (wheels, moved) in enumerate(simulated_moves(ROBOTS[1], 300, rng)):
        slipped = number > 30 and number % 10 == 0
        seen = moved - [0.4, 0, 0] if slipped else moved
        flags.append((slipped, odometry.learn(wheels, Move(seen, REGISTERED)) > SETTINGS.slip_gate))
    assert all(flagged for slipped, flagged in flags if slipped)
    np.testing.assert_allclose(odometry.calibration, ROBOTS[1], atol=0.02)


def test_a_turn_across_the_half_turn_is_no_slip() -> None:
    odometry = Odometry(replace(SETTINGS, turn_noise=0.01))
    wheels, moved = np.array([0.0, 0.0, np.pi - 0.01]), np.array([0.0, 0.0, -np.pi + 0.01])
    assert odometry.learn(wheels, Move(moved, REGISTERED)) < 1


def test_arguments_are_not_written_into() -> None:
    wheels, moved = np.array([0.1, 0.0, 0.1]), np.array([0.12, 0.0, 0.11])
    odometry = Odometry(SETTINGS)
    odometry.predict(wheels)
    odometry.learn(wheels, Move(moved, REGISTERED))
    np.testing.assert_array_equal(wheels, [0.1, 0, 0.1])
    np.testing.assert_array_equal(moved, [0.12, 0, 0.11])


def settled(count: int = 20) -> Odometry:
    """A filter that saw the robot go half a metre every half second."""
    odometry, move = Odometry(SETTINGS), np.array([0.5, 0.0, 0.0])
    for _ in range(count):
        odometry.expect(move, 0.5)
        odometry.learn(move, Move(move, REGISTERED), 0.5)
    return odometry


def test_after_a_gap_in_the_log_the_wheels_are_followed_but_doubted() -> None:
    odometry, move = settled(), np.array([0.5, 0.0, 0.0])
    expected, why = odometry.expect(move, 60.0)
    assert why == "60.0 s without a scan, usually 0.50 s"
    np.testing.assert_allclose(expected.pose, odometry.predict(move).pose)
    assert expected.covariance[0, 0] > SETTINGS.lost_metres**2


def test_a_move_that_no_robot_makes_is_not_followed() -> None:
    expected, why = settled().expect(np.array([40.0, 0.0, 0.0]), 0.5)
    assert why == "the wheels claim 40.0 m in 0.50 s"
    np.testing.assert_array_equal(expected.pose, 0)


def test_slow_scans_are_no_gaps() -> None:
    odometry = Odometry(SETTINGS)
    whys = [odometry.expect(np.array([0.5, 0.0, 0.0]), seconds)[1] for seconds in (30.0, 35.0, 28.0, 40.0)]
    assert whys == [None] * 4


def test_wheels_that_stand_still_while_the_robot_goes_on_are_not_asked_again_until_they_agree() -> None:
    odometry, stuck, went = settled(), np.zeros(3), np.array([0.5, 0.0, 0.0])
    for _ in range(SETTINGS.slips):
        assert odometry.learn(stuck, Move(went, REGISTERED), 0.5) > SETTINGS.slip_gate
    np.testing.assert_allclose(odometry.expect(stuck, 0.5)[0].pose, went)
    odometry.learn(went, Move(went, REGISTERED), 0.5)
    np.testing.assert_allclose(odometry.expect(went, 0.5)[0].pose, odometry.predict(went).pose)


def test_without_wheels_a_robot_that_drives_on_is_expected_to_and_one_that_starts_and_stops_is_not() -> None:
    """The doubt covers what the moves of late would have been off."""
    forward = np.array([0.3, 0.0, 0.0])
    for moves, expected in (([forward] * 10, forward), ([forward, 0 * forward] * 5, 0 * forward)):
        odometry = Odometry(SETTINGS)
        for move in moves:
            odometry.learn(np.zeros(3), Move(move, REGISTERED))
        steady = odometry.steady(1.0)
        np.testing.assert_allclose(steady.pose, expected, atol=1e-9)
        assert np.sqrt(steady.covariance[0, 0]) >= SETTINGS.lost_metres


def test_doubt_grows_with_every_move_that_nobody_saw() -> None:
    odometry = Odometry(SETTINGS)
    before = odometry.steady(1.0).covariance
    odometry.lose()
    np.testing.assert_allclose(odometry.steady(1.0).covariance, 4 * before)


def test_stuck_wheels_are_not_believed_again_while_the_robot_stands() -> None:
    odometry = Odometry(SETTINGS)
    for _ in range(SETTINGS.slips):
        odometry.learn(np.zeros(3), Move(np.array([0.5, 0.0, 0.0]), REGISTERED))
    assert odometry.broken
    odometry.learn(np.zeros(3), Move(np.zeros(3), REGISTERED))
    assert odometry.broken
    odometry.learn(np.array([0.3, 0.0, 0.0]), Move(np.array([0.3, 0.0, 0.0]), REGISTERED))
    assert not odometry.broken


def test_noisy_turns_of_a_long_straight_drive_do_not_teach_that_turns_mean_nothing() -> None:
    rng = np.random.default_rng(0)
    odometry = Odometry(SETTINGS)
    for _ in range(600):
        made = driven_arc(0.4, float(rng.normal(0, 0.002)))
        felt = driven_arc(0.4 * (1 + 0.05 * rng.normal()), made[2] + 0.015 * float(rng.normal()))
        odometry.learn(felt, Move(made, REGISTERED))
    assert odometry.calibration[1] == pytest.approx(1.0, abs=0.02)
    corner = driven_arc(0.4, 0.6)
    assert odometry.learn(corner, Move(corner, REGISTERED)) < SETTINGS.slip_gate


def unbelieved(odometry: Odometry) -> Odometry:
    """Its wheels were wrong so often in a row that they are not asked."""
    for _ in range(SETTINGS.slips):
        odometry.learn(np.array([0.5, 0.0, 0.0]), Move(np.zeros(3), REGISTERED))
    assert odometry.broken
    return odometry


@pytest.mark.parametrize(("claimed", "broken"), [(0.4, False), (0.0, True)])
def test_where_a_robot_slides_wheels_that_were_right_before_are_asked_again_if_they_claim_a_move(
    claimed: float, broken: bool
) -> None:
    along = Move(np.array([0.6, 0.0, 0.0]), np.diag([0.5, 0.01, 0.002]) ** 2)
    odometry = Odometry(SETTINGS)
    odometry.learn(np.array([0.3, 0.0, 0.0]), Move(np.array([0.3, 0.0, 0.0]), REGISTERED))
    unbelieved(odometry).slide(np.array([claimed, 0.0, 0.0]), along)
    assert odometry.broken is broken
    never_right = unbelieved(Odometry(SETTINGS))
    never_right.slide(np.array([0.4, 0.0, 0.0]), along)
    assert never_right.broken
