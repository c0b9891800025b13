import numpy as np
import pytest
from shapely import box

from frontend.matching import MatchingSettings, match_lost, match_near, same_kind
from frontend.rigid_motion import between, transform
from frontend.scan import Floats
from tests.frontend.rooms import FURNISHED, L_ROOM, sketched

SETTINGS = MatchingSettings()
DOUBT = np.diag([0.15, 0.15, 0.08]) ** 2
PAIRS = [
    (np.array([2.8, 1.2, 0.2]), np.array([3.3, 1.5, 0.6])),
    (np.array([6.8, 1.2, 2.0]), np.array([6.6, 3.6, -2.0])),
    (np.array([0.8, 2.0, 0.0]), np.array([1.0, 1.4, -0.5])),
]


@pytest.mark.parametrize(("here", "there"), PAIRS)
def test_near_sketches_give_the_move_between_them(here: Floats, there: Floats) -> None:
    move = between(here, there)
    guess = move + np.array([0.1, -0.1, 0.05])
    matches = match_near(sketched(FURNISHED, here), sketched(FURNISHED, there, 1), guess, DOUBT, SETTINGS)
    assert matches.pose_in_fixed is not None, matches.reason
    assert np.allclose(between(move, matches.pose_in_fixed), 0.0, atol=0.06)
    assert len(matches.pairs) >= 4


@pytest.mark.parametrize(("here", "there"), PAIRS)
def test_lost_sketches_are_found_without_any_guess(here: Floats, there: Floats) -> None:
    matches = match_lost(sketched(FURNISHED, here), sketched(FURNISHED, there, 1), SETTINGS)
    assert matches.pose_in_fixed is not None, matches.reason
    assert np.allclose(between(between(here, there), matches.pose_in_fixed), 0.0, atol=0.06)


def test_the_covariance_says_how_far_off_the_move_is() -> None:
    here, there = PAIRS[0]
    move, errors = between(here, there), []
    for seed in range(25):
        matches = match_near(
            sketched(FURNISHED, here, seed), sketched(FURNISHED, there, 100 + seed), move, DOUBT, SETTINGS
        )
        assert matches.pose_in_fixed is not None
        assert matches.covariance is not None
        off = matches.pose_in_fixed - move
        errors.append(off @ np.linalg.inv(matches.covariance) @ off)
    assert np.mean(errors) < 4.0


def test_different_rooms_are_not_matched() -> None:
    matches = match_lost(sketched(FURNISHED, PAIRS[0][0]), sketched(L_ROOM, np.array([1.0, 1.0, 0.0])), SETTINGS)
    assert matches.pose_in_fixed is None
    assert matches.covariance is None
    assert "%" in matches.reason or "knots" in matches.reason


def test_a_room_that_looks_the_same_both_ways_is_not_decided() -> None:
    room = box(0, 0, 6, 4)
    matches = match_lost(
        sketched(room, np.array([3.0, 2.0, 0.0])), sketched(room, np.array([3.4, 2.2, 0.1]), 1), SETTINGS
    )
    assert matches.pose_in_fixed is None
    assert "another pose" in matches.reason


def test_a_corridor_says_that_the_pose_could_slide() -> None:
    dead_end = box(-60, 0, 4, 0.8)
    here, there = np.array([0.0, 0.4, 0.0]), np.array([0.5, 0.4, 0.1])
    matches = match_lost(sketched(dead_end, here), sketched(dead_end, there, 1), SETTINGS)
    assert matches.pose_in_fixed is None
    assert "sliding" in matches.reason


def test_the_knots_of_a_lost_match_coincide_at_its_pose() -> None:
    here, there = PAIRS[0]
    fixed, moving = sketched(FURNISHED, here), sketched(FURNISHED, there, 1)
    matches = match_lost(fixed, moving, SETTINGS)
    assert matches.pose_in_fixed is not None
    assert len(matches.pairs) >= 4
    a, b = matches.pairs.T
    gaps = np.linalg.norm(fixed.positions[a] - transform(moving.positions[b], matches.pose_in_fixed), axis=1)
    assert np.all(gaps < SETTINGS.distance_gate)


def test_two_faces_of_a_thin_wall_are_never_one_knot() -> None:
    divided = box(0, 0, 6, 5).difference(box(2.95, 0, 3.05, 3.0))
    left, right = sketched(divided, np.array([1.5, 1.0, 0.0])), sketched(divided, np.array([4.5, 1.0, np.pi]))
    matches = match_near(left, right, between(np.array([1.5, 1.0, 0.0]), np.array([4.5, 1.0, np.pi])), DOUBT, SETTINGS)
    for a, b in matches.pairs:
        shared = ~np.isnan(left.walls[a]) & ~np.isnan(right.walls[b])
        turned = left.walls[a][shared] - right.walls[b][shared] - np.pi
        assert np.all(np.cos(turned) > 0.9)


def test_corners_pair_only_with_the_same_turn() -> None:
    seen = sketched(L_ROOM, np.array([1.8, 1.5, 0.3]))
    corners = np.flatnonzero(seen.landmark)
    alike = same_kind(seen, corners, seen, corners, SETTINGS)
    assert alike.diagonal().all()
    signs = np.sign(seen.turns[corners])
    assert not alike[signs[:, None] != signs[None]].any()


def test_nothing_to_match_says_so() -> None:
    empty = sketched(box(0, 0, 6, 5), np.array([3.0, 2.0, 0.0]))
    few = match_near(empty, empty, np.array([9.0, 9.0, 0.0]), DOUBT, SETTINGS)
    assert few.pose_in_fixed is None
    assert "agree with the guess" in few.reason
