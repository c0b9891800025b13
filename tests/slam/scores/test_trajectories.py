"""Trajectory scores: the same numbers as evo, and hand-made relations between scans."""

from pathlib import Path

import numpy as np
import pytest
from evo.core import metrics
from evo.core.trajectory import PosePath3D
from hypothesis import given, settings
from hypothesis import strategies as st

from frontend.rigid_motion import between, compose, transform
from frontend.scan import Floats
from slam.scores.trajectories import (
    RelationsError,
    Spread,
    Track,
    absolute_errors,
    align,
    nearest_in_time,
    read_relations,
    relation_errors,
    relative_errors,
)

seeds = st.integers(0, 2**32 - 1)


def wandering(rng: np.random.Generator, count: int) -> Floats:
    poses = [np.zeros(3)]
    for _ in range(count - 1):
        poses.append(compose(poses[-1], np.array([rng.uniform(0, 1), 0.0, rng.normal(0, 0.4)])))
    return np.array(poses)


def in_space(poses: Floats) -> PosePath3D:
    matrices = []
    for x, y, heading in poses:
        matrix = np.eye(4)
        matrix[:2, :2] = [[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]]
        matrix[:2, 3] = x, y
        matrices.append(matrix)
    return PosePath3D(poses_se3=matrices)


@pytest.mark.parametrize("seed", range(5))
def test_absolute_errors_are_those_of_evo(seed: int) -> None:
    rng = np.random.default_rng(seed)
    true = wandering(rng, 60)
    frame = rng.uniform(-3, 3, 3)
    estimated = np.array([compose(frame, pose) for pose in true + rng.normal(0, 0.1, true.shape)])
    theirs = in_space(estimated)
    theirs.align(in_space(true))
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data((in_space(true), theirs))
    ours = absolute_errors(estimated[:, :2], true[:, :2])
    np.testing.assert_allclose(ours, ape.error, atol=1e-6)
    assert Spread.of(ours).rmse == pytest.approx(ape.get_statistic(metrics.StatisticsType.rmse))


@pytest.mark.parametrize("seed", range(5))
def test_relative_errors_are_those_of_evo(seed: int) -> None:
    rng = np.random.default_rng(seed)
    true = wandering(rng, 60)
    estimated = true + rng.normal(0, 0.05, true.shape)
    metres, radians = relative_errors(estimated, true)
    for ours, relation in (
        (metres, metrics.PoseRelation.translation_part),
        (radians, metrics.PoseRelation.rotation_angle_rad),
    ):
        rpe = metrics.RPE(relation, delta=1, delta_unit=metrics.Unit.frames)
        rpe.process_data((in_space(true), in_space(estimated)))
        np.testing.assert_allclose(ours, rpe.error, atol=1e-6)


@settings(deadline=None, max_examples=30)
@given(seeds)
def test_alignment_recovers_a_known_motion(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points, motion = rng.uniform(-5, 5, (10, 2)), np.array([*rng.uniform(-9, 9, 2), rng.uniform(-3, 3)])
    np.testing.assert_allclose(align(points, transform(points, motion)), motion, atol=1e-9)


@settings(deadline=None, max_examples=30)
@given(seeds)
def test_errors_do_not_depend_on_the_frame_of_the_estimate(seed: int) -> None:
    rng = np.random.default_rng(seed)
    true = wandering(rng, 20)
    estimated, frame = true + rng.normal(0, 0.1, true.shape), rng.uniform(-3, 3, 3)
    moved = np.array([compose(frame, pose) for pose in estimated])
    np.testing.assert_allclose(
        absolute_errors(moved[:, :2], true[:, :2]), absolute_errors(estimated[:, :2], true[:, :2]), atol=1e-9
    )
    np.testing.assert_allclose(relative_errors(moved, true), relative_errors(estimated, true), atol=1e-9)


def test_a_list_of_errors_is_summarised() -> None:
    spread = Spread.of(np.array([0.0, 3.0, 4.0, 1.0]))
    assert (spread.mean, spread.median, spread.worst, spread.count) == (2.0, 2.0, 4.0, 4)
    assert spread.rmse == pytest.approx(np.sqrt(26 / 4))
    assert spread.std**2 == pytest.approx(spread.rmse**2 - spread.mean**2)


def straight_track(odometry_scale: float = 1.0) -> Track:
    """A metre a second along x; the wheels measure four times as often, on another scale."""
    times, fine = np.arange(5.0), np.arange(0, 4.01, 0.25)
    poses = np.column_stack([times, np.zeros((5, 2))])
    return Track(times, poses, fine, np.column_stack([odometry_scale * fine, np.zeros((len(fine), 2))]))


@pytest.mark.parametrize("time", [0.0, 0.1, 1.0, 2.625, 4.0])
@pytest.mark.parametrize("scale", [1.0, 1.3])
def test_between_scans_the_pose_is_carried_by_odometry_and_blended(time: float, scale: float) -> None:
    """A wrong scale is carried forward from one side and backward from the other; the blend takes it out."""
    np.testing.assert_allclose(straight_track(scale).at(time), [time, 0, 0], atol=1e-12)


def test_between_scans_a_bend_that_only_the_wheels_felt_is_followed() -> None:
    """Two scans a second apart; in between the robot drove out to the side and back, as its odometry says."""
    odometry = np.array([[0.0, 0, 0], [0.5, 0.4, 0], [1.0, 0, 0]])
    track = Track(np.array([0.0, 1.0]), np.array([[5.0, 0, 0], [6.0, 0, 0]]), np.array([0.0, 0.5, 1.0]), odometry)
    np.testing.assert_allclose(track.at(0.5), [5.5, 0.4, 0], atol=1e-12)


def test_headings_are_blended_the_short_way_round() -> None:
    poses = np.array([[0.0, 0, np.pi - 0.1], [0.0, 0, -np.pi + 0.1]])
    track = Track(np.array([0.0, 1.0]), poses, np.array([0.0, 1.0]), poses)
    heading = track.at(0.5)[2]
    assert np.cos(heading) == pytest.approx(-1)


def test_before_the_first_and_after_the_last_scan_the_robot_stands() -> None:
    track = straight_track()
    np.testing.assert_allclose(track.at(-3.0), [0, 0, 0])
    np.testing.assert_allclose(track.at(9.0), [4, 0, 0])


def test_relations_that_hold_have_no_error_and_others_have_theirs() -> None:
    relations = np.array(
        [[0.0, 2.0, 2.0, 0, 0], [0.5, 3.5, 3.0, 0, 0], [0.0, 1.0, 1.3, 0.4, 0], [1.0, 2.0, 1, 0, -0.2]]
    )
    metres, radians = relation_errors(straight_track(), relations)
    np.testing.assert_allclose(metres, [0, 0, 0.5, 0], atol=1e-12)
    np.testing.assert_allclose(radians, [0, 0, 0, 0.2], atol=1e-12)


@settings(deadline=None, max_examples=15)
@given(seeds)
def test_relations_of_the_trajectory_itself_hold_in_any_frame(seed: int) -> None:
    rng = np.random.default_rng(seed)
    poses, times = wandering(rng, 12), np.arange(12.0)
    track = Track(times, np.array([compose(np.array([4.0, 2.0, 1.0]), pose) for pose in poses]), times, poses)
    pairs = rng.integers(0, 12, (20, 2))
    relations = np.array([[a, b, *between(poses[a], poses[b])] for a, b in pairs], float)
    metres, radians = relation_errors(track, relations)
    assert np.max(metres) < 1e-9
    assert np.max(radians) < 1e-9


def test_relations_outside_the_trajectory_are_an_error_with_the_numbers() -> None:
    with pytest.raises(RelationsError, match=r"1 of 2 relations lie outside the trajectory's times 0\.00 to 4\.00"):
        relation_errors(straight_track(), np.array([[0.0, 1.0, 1, 0, 0], [0.0, 50.0, 1, 0, 0]]))


def test_relations_are_read_and_damage_is_named_by_its_line(tmp_path: Path) -> None:
    path = tmp_path / "a.relations"
    path.write_text("# t1 t2 x y z roll pitch yaw\n1 2 3 4 0 0 0 0.5\n\n2 3 1 1 0 0 0 -0.5\n")
    np.testing.assert_array_equal(read_relations(path), [[1, 2, 3, 4, 0.5], [2, 3, 1, 1, -0.5]])
    path.write_text("1 2 3 4 0 0 0 0.5\n1 2 3\n")
    with pytest.raises(RelationsError, match=r"a\.relations line 2: needs 8 numbers"):
        read_relations(path)
    path.write_text("1 2 3 4 0 0 0 nan\n")
    with pytest.raises(RelationsError, match=r"a\.relations line 1: a number is not finite"):
        read_relations(path)
    with pytest.raises(RelationsError, match=r"b\.relations cannot be read: No such file"):
        read_relations(tmp_path / "b.relations")
    path.write_text("# nothing\n")
    with pytest.raises(RelationsError, match="holds no relation"):
        read_relations(path)


@settings(deadline=None, max_examples=40)
@given(seeds, st.integers(1, 30))
def test_nearest_times_are_those_of_a_full_search(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    times, wanted = np.sort(rng.uniform(0, 10, count)), np.sort(rng.uniform(-1, 11, 20))
    ours, theirs = nearest_in_time(times, wanted, 0.3)
    gaps = np.abs(times[None] - wanted[:, None])
    np.testing.assert_array_equal(theirs, np.flatnonzero(gaps.min(axis=1) <= 0.3))
    np.testing.assert_array_equal(ours, gaps.argmin(axis=1)[theirs])
