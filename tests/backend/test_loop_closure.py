"""Loop closure: how doubt grows along the graph, and which earlier poses are worth a look."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.loop_closure import Candidate, Drift, LoopSettings, beyond_search, outlook
from backend.loop_closure import candidates as candidates_of
from frontend.scan import Floats


def candidates(poses: Floats, drift: Drift, wanted: LoopSettings) -> list[Candidate]:
    return candidates_of(outlook(poses, drift, wanted), drift, wanted)


def beyond(poses: Floats, drift: Drift, wanted: LoopSettings) -> list[Candidate]:
    return beyond_search(outlook(poses, drift, wanted), drift, wanted)


STEP = np.diag([0.02, 0.02, 0.01]) ** 2
SETTINGS = LoopSettings(skipped=10, apart=5)


def chain(count: int, covariance: Floats = STEP) -> Drift:
    drift = Drift()
    for k in range(1, count):
        drift.add(k - 1, k, covariance)
    return drift


def straight(count: int) -> Floats:
    return np.column_stack([np.arange(float(count)), np.zeros(count), np.zeros(count)])


def circle(count: int, radius: float = 5.0, rounds: float = 1.0) -> Floats:
    angles = np.linspace(0, 2 * np.pi * rounds, count)
    return np.column_stack([radius * np.cos(angles), radius * np.sin(angles), angles + np.pi / 2])


def test_doubt_grows_along_a_chain_and_is_nothing_where_the_robot_is() -> None:
    place, heading = chain(20).place_from(19, straight(20)[:, :2]), chain(20).heading_from(19, 20)
    assert place[19] == 0
    assert heading[19] == 0
    assert np.all(np.diff(place) < 0)
    np.testing.assert_allclose(heading, 0.01 * np.sqrt(np.arange(19, -1, -1)))


def test_doubt_of_the_heading_swings_what_lies_far_away() -> None:
    """The variance of a straight way: of each step its own, and its heading's times the squared lever."""
    count = 15
    place = chain(count).place_from(count - 1, straight(count)[:, :2])
    levers = np.arange(count - 1)
    variance = (count - 1) * (STEP[0, 0] + STEP[1, 1]) + STEP[2, 2] * np.sum(levers**2)
    assert place[0] == pytest.approx(np.sqrt(variance))


def test_a_loop_takes_the_doubt_away() -> None:
    drift, poses = chain(30), circle(30)
    before = drift.place_from(29, poses[:, :2])
    drift.add(0, 29, STEP)
    after = drift.place_from(29, poses[:, :2])
    assert after[0] < 0.2 * before[0]
    assert np.all(after <= before + 1e-12)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_no_tie_between_other_poses_ever_adds_doubt(seed: int) -> None:
    rng = np.random.default_rng(seed)
    drift, places = chain(20), rng.uniform(-5, 5, (20, 2))
    before = drift.place_from(19, places)
    fixed, moving = np.sort(rng.choice(20, 2, replace=False))
    if moving - fixed > 1:
        drift.add(int(fixed), int(moving), np.diag(rng.uniform(0.001, 0.1, 3)) ** 2)
    assert np.all(drift.place_from(19, places) <= before + 1e-12)


def test_a_second_tie_between_the_same_poses_does_not_add_doubt() -> None:
    drift, places = chain(5), straight(5)[:, :2]
    before = drift.place_from(4, places)
    drift.add(2, 3, STEP)
    after = drift.place_from(4, places)
    assert np.all(after <= before + 1e-12)


def test_back_at_the_start_the_start_is_the_first_candidate() -> None:
    poses = circle(60)
    found = candidates(poses, chain(60), SETTINGS)
    assert found[0].pose == 0
    assert all(isinstance(candidate, Candidate) for candidate in found)


def test_the_newest_poses_are_no_candidates() -> None:
    poses = np.zeros((40, 3))
    for candidate in candidates(poses, chain(40), SETTINGS):
        assert candidate.pose < 39 - SETTINGS.skipped
    assert candidates(poses[:10], chain(10), SETTINGS) == []


def test_candidates_are_spread_out_the_nearest_first_and_not_too_many() -> None:
    poses = circle(120, rounds=3)
    chosen = candidates(poses, chain(120), replace(SETTINGS, at_once=3))
    assert 1 < len(chosen) <= 3
    places = [candidate.pose for candidate in chosen]
    assert all(abs(a - b) > SETTINGS.apart for a in places for b in places if a != b)
    gaps = np.linalg.norm(poses[places, :2] - poses[-1, :2], axis=1)
    assert np.all(np.diff(gaps) >= -1e-6)


def test_a_robot_that_drives_on_straight_has_no_candidates() -> None:
    assert candidates(straight(60), chain(60, STEP / 100), SETTINGS) == []


def test_more_doubt_finds_what_drift_has_put_far_away() -> None:
    """A loop that is open by 3 m: a sure odometry sees no loop, a poor one searches there, and says how wide."""
    poses = circle(60)
    poses[:, 0] += np.linspace(0, 4.0, 60)
    sure, poor = chain(60, STEP / 400), chain(60, STEP * 16)
    assert candidates(poses, sure, SETTINGS) == []
    found = candidates(poses, poor, SETTINGS)
    assert found[0].pose < 5
    assert found[0].metres > 2.0


def test_windows_are_so_many_sigmas_of_doubt_and_never_wider_than_allowed() -> None:
    poses = circle(60)
    small = candidates(poses, chain(60), SETTINGS)[0]
    place, heading = chain(60).place_from(59, poses[:, :2]), chain(60).heading_from(59, 60)
    assert small.metres == pytest.approx(min(SETTINGS.sigmas * place[0], SETTINGS.widest))
    assert small.radians == pytest.approx(SETTINGS.sigmas * heading[0])
    wide = candidates(poses, chain(60, STEP * 1e4), SETTINGS)[0]
    assert wide.metres == SETTINGS.widest
    assert small.covered
    assert not wide.covered


def test_what_no_window_covers_is_told_with_all_its_doubt() -> None:
    """A poor odometry on a circle: its start may be anywhere; a sure one leaves nothing to be told."""
    poses, poor = circle(60), chain(60, STEP * 1e3)
    told = beyond(poses, poor, SETTINGS)
    place = poor.place_from(59, poses[:, :2])
    assert [one.pose for one in told] == list(range(len(told)))
    assert all(one.metres == pytest.approx(SETTINGS.sigmas * place[one.pose]) for one in told)
    assert min(one.metres for one in told) > SETTINGS.widest
    assert not any(one.covered for one in told)
    assert max(one.radians for one in told) <= np.pi
    assert beyond(poses, chain(60), SETTINGS) == []


def test_a_place_farther_off_than_its_doubt_is_not_told() -> None:
    poses = straight(300)
    drift = chain(300, STEP * 4)
    told = {one.pose for one in beyond(poses, drift, SETTINGS)}
    doubts = SETTINGS.sigmas * drift.place_from(299, poses[:, :2])
    assert all(299 - pose < SETTINGS.near + doubts[pose] for pose in told)


def test_a_submap_errs_by_the_mean_of_its_walks_away_from_the_middle() -> None:
    """Against walks that are drawn: six steps to either side, each as unsure as the chain says."""
    rng, beside, steps = np.random.default_rng(0), 6, 20000
    walks = np.cumsum(rng.normal(0, 0.02, (steps, 2, beside)), axis=2)
    mean = walks.sum(axis=(1, 2)) / (2 * beside + 1)
    submap = chain(40).of_submap(20, beside)
    assert np.sqrt(submap[0, 0]) == pytest.approx(mean.std(), rel=0.03)
    np.testing.assert_allclose(submap, np.diag([STEP[0, 0], STEP[0, 0], STEP[2, 2]]) * submap[0, 0] / STEP[0, 0])


def test_a_submap_of_a_pose_without_a_chain_is_as_sure_as_can_be() -> None:
    np.testing.assert_array_equal(Drift().of_submap(0, 6), np.zeros((3, 3)))
