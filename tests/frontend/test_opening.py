from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from frontend.opening import expected_maxima, smeared, undo_beam
from frontend.scan import Floats
from tests.frontend.rooms import L_ROOM, first_echoes, true_ranges, turn

BEARINGS = turn(256)
profiles = st.lists(st.floats(0.5, 9.0), min_size=256, max_size=256).map(np.array)


def constant(half_beam: float) -> Any:
    return np.array([[np.inf, half_beam]])


beams = st.sampled_from([np.radians(5), np.radians(10), np.radians(20)])


@settings(deadline=None, max_examples=20)
@given(profiles, beams)
def test_the_opened_profile_lies_between_the_echoes_and_the_truth(truth: Floats, half_beam: float) -> None:
    echoes = first_echoes(truth, half_beam)
    opened = undo_beam(BEARINGS, echoes, np.array([[np.inf, half_beam]]), 0.0, full_turn=True)
    assert np.all(opened >= echoes)
    assert np.all(opened <= truth)


@settings(deadline=None, max_examples=20)
@given(profiles, beams)
def test_opening_what_is_open_changes_nothing(truth: Floats, half_beam: float) -> None:
    opened = undo_beam(BEARINGS, first_echoes(truth, half_beam), np.array([[np.inf, half_beam]]), 0.0, full_turn=True)
    again = undo_beam(BEARINGS, first_echoes(opened, half_beam), np.array([[np.inf, half_beam]]), 0.0, full_turn=True)
    assert np.allclose(again, opened)


def test_walls_come_back_exactly_and_only_corners_stay_short() -> None:
    pose = np.array([1.5, 1.2, 0.3])
    truth, _ = true_ranges(L_ROOM, pose, BEARINGS)
    half_beam = np.radians(10)
    opened = undo_beam(BEARINGS, first_echoes(truth, half_beam), np.array([[np.inf, half_beam]]), 0.0, full_turn=True)
    assert np.mean(opened > truth - 1e-9) > 0.5
    assert np.mean(truth - opened) < 0.35 * np.mean(truth - first_echoes(truth, half_beam))


def test_a_narrow_beam_leaves_the_ranges_alone() -> None:
    ranges = np.linspace(1, 2, 256)
    assert np.array_equal(undo_beam(BEARINGS, ranges, np.array([[np.inf, 0.0]]), 0.0, full_turn=True), ranges)


def test_silent_readings_never_spread() -> None:
    ranges = np.full(256, 2.0)
    ranges[100] = np.nan
    assert np.all(undo_beam(BEARINGS, ranges, np.array([[np.inf, np.radians(10)]]), 0.0, full_turn=True) == 2.0)


def test_a_part_turn_does_not_reach_across_its_ends() -> None:
    bearings = np.radians(np.arange(-90.0, 91.0))
    ranges = np.where(bearings < -1.5, 5.0, 1.0)
    assert undo_beam(bearings, ranges, np.array([[np.inf, np.radians(10)]]), 0.0, full_turn=False)[-1] == 1.0


def test_a_beam_that_narrows_with_the_range_vouches_off_its_axis_only_as_far_as_it_hears() -> None:
    """Heard to 2 m at 10° off the axis and to 4 m at 5°: the far reading opens its neighbours that far, not farther."""
    bearings = np.radians(np.arange(-20.0, 21.0, 5.0))
    ranges = np.where(np.abs(bearings) < 1e-9, 6.0, 1.0)
    opened = undo_beam(bearings, ranges, np.array([[2.0, np.radians(10)], [4.0, np.radians(5)]]), 0.0, full_turn=False)
    assert np.allclose(opened, [1, 1, 2, 4, 6, 4, 2, 1, 1])


@settings(deadline=None, max_examples=20)
@given(profiles)
def test_a_narrowing_beam_too_never_goes_beyond_the_truth(truth: Floats) -> None:
    beam = np.array([[0.5, np.radians(30)], [2.0, np.radians(15)], [9.0, np.radians(4)]])
    width = np.interp(truth, beam[:, 0], beam[:, 1])
    apart = np.abs(np.mod(BEARINGS[:, None] - BEARINGS[None] + np.pi, 2 * np.pi) - np.pi)
    echoes = np.min(np.where(apart <= width[None] + 1e-9, truth[None], np.inf), axis=1)
    opened = undo_beam(BEARINGS, echoes, beam, 0.0, full_turn=True)
    assert np.all(opened >= echoes)
    assert np.all(opened <= truth + 1e-9)


def test_a_corner_the_beam_cannot_see_into_is_a_bound_and_a_wall_met_squarely_is_not() -> None:
    """A plateau that falls off on both sides against one that rises on both."""
    corner = np.array([2.0, 2.1, 2.3, 2.3, 2.3, 2.3, 2.1, 2.0, 1.9, 1.9])
    wall = np.array([2.6, 2.3, 2.2, 2.2, 2.2, 2.2, 2.3, 2.6, 2.9, 2.7])
    assert smeared(corner, 0.02, 3, full_turn=False).tolist() == [2, 3, 4, 5]
    assert smeared(wall, 0.02, 3, full_turn=False).size == 0


def test_a_corner_across_the_wrap_around_is_a_bound_too() -> None:
    ring = np.array([2.3, 2.3, 2.1, 2.0, 1.9, 2.0, 2.1, 2.3])
    assert smeared(ring, 0.02, 3, full_turn=True).tolist() == [0, 1, 7]


@pytest.mark.parametrize("degrees", [5, 10, 20])
def test_the_farthest_of_many_noisy_readings_of_a_flat_wall_is_drawn_back_onto_it(degrees: int) -> None:
    """Around the foot of the normal the beam reads one range; its maximum over the window leans outwards by 1.3–2 σ."""
    noise, beam = 0.01, np.radians(degrees)
    truth, _ = true_ranges(box(-9, -9, 2, 9), np.zeros(3), BEARINGS)
    at_foot = np.abs(BEARINGS) < 0.5 * beam
    exact = first_echoes(truth, beam)
    leans, stays = [], []
    for seed in range(20):
        echoes = exact + np.random.default_rng(seed).normal(0.0, noise, 256)
        leans.append(undo_beam(BEARINGS, echoes, constant(beam), 0.0, full_turn=True) - truth)
        stays.append(undo_beam(BEARINGS, echoes, constant(beam), noise, full_turn=True) - truth)
    assert np.mean(np.array(leans)[:, at_foot]) > 1.0 * noise
    assert abs(np.mean(np.array(stays)[:, at_foot])) < 0.5 * noise
    on_wall = np.abs(BEARINGS) < np.radians(50)
    assert np.max(np.abs(np.mean(np.array(stays)[:, on_wall], axis=0))) < 1.2 * noise


def test_expected_maxima_are_those_of_normal_values() -> None:
    drawn = np.random.default_rng(0).normal(size=(20000, 15))
    expected = expected_maxima(15)
    assert [np.max(drawn[:, :k], axis=1).mean() for k in (1, 2, 5, 15)] == pytest.approx(
        expected[[1, 2, 5, 15]], abs=0.03
    )
