"""Corners of one map on those of another: found from any doubt, and never without enough in common."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from frontend.corner_constellations import ConstellationSettings, PlacedCorners, poses_of_corners
from frontend.rigid_motion import compose, inverse, rotation, transform, wrap
from frontend.scan import Floats

SETTINGS = ConstellationSettings()
ANYWHERE = (60.0, np.pi)


def corners(rng: np.random.Generator, count: int, size: float = 20.0) -> PlacedCorners:
    """Right angles, convex and concave, of walls in two directions."""
    turns = rng.choice([-np.pi / 2, np.pi / 2], count)
    headings = rng.choice(np.arange(4), count) * np.pi / 2 + np.pi / 4
    return PlacedCorners(rng.uniform(-size, size, (count, 2)), turns, headings)


def carried(known: PlacedCorners, chosen: Floats, motion: Floats, noise: Floats) -> PlacedCorners:
    """Some of them in a frame that lies at `motion` (3,) in theirs."""
    back = inverse(motion)
    places = transform(known.positions[chosen.astype(int)], back) + noise
    return PlacedCorners(places, known.turns[chosen.astype(int)], wrap(known.headings[chosen.astype(int)] + back[2]))


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 2**32 - 1))
def test_six_corners_say_where_the_robot_stands_whatever_was_believed(seed: int) -> None:
    rng = np.random.default_rng(seed)
    known = corners(rng, 40)
    seen = np.argsort(np.linalg.norm(known.positions - known.positions[0], axis=1))[:6].astype(float)
    motion = np.array([*rng.uniform(-10, 10, 2), rng.uniform(-np.pi, np.pi)])
    newest = carried(known, seen, motion, rng.normal(0, 0.02, (6, 2)))
    believed = np.array([*newest.positions.mean(axis=0), 0.3])
    found = poses_of_corners(known, newest, believed, ANYWHERE, SETTINGS)[0]
    np.testing.assert_allclose(found[:2], compose(motion, believed)[:2], atol=0.1)
    assert abs(wrap(found[2:] - compose(motion, believed)[2:])[0]) < 0.05


def test_three_corners_in_common_propose_nothing() -> None:
    rng = np.random.default_rng(0)
    known = corners(rng, 12)
    newest = carried(known, np.arange(3.0), np.array([5.0, 1.0, 0.4]), np.zeros((3, 2)))
    assert poses_of_corners(known, newest, np.zeros(3), ANYWHERE, SETTINGS) == []


@pytest.mark.parametrize(("window", "proposed"), [((6.0, 0.5), True), ((3.0, 0.5), False), ((6.0, 0.2), False)])
def test_only_poses_within_the_doubt_are_proposed(window: tuple[float, float], proposed: bool) -> None:
    rng = np.random.default_rng(1)
    known, motion = corners(rng, 20), np.array([5.0, 0.0, 0.4])
    newest = carried(known, np.arange(8.0), motion, np.zeros((8, 2)))
    assert bool(poses_of_corners(known, newest, np.zeros(3), window, SETTINGS)) is proposed


def test_corners_that_look_the_same_but_face_elsewhere_are_not_one() -> None:
    """A pillar's outer corners against those of a niche of the same size: convex ones are no concave ones."""
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [3.0, 0.5]])
    headings = np.array([-3, -1, 1, 3, 0]) * np.pi / 4
    pillar = PlacedCorners(square, np.full(5, -np.pi / 2), headings)
    niche = PlacedCorners(square, np.full(5, np.pi / 2), headings)
    assert poses_of_corners(pillar, niche, np.zeros(3), ANYWHERE, SETTINGS) == []
    found = poses_of_corners(pillar, pillar, np.zeros(3), ANYWHERE, SETTINGS)
    np.testing.assert_allclose(found[0], np.zeros(3), atol=1e-9)


def test_no_corners_propose_nothing() -> None:
    none = PlacedCorners(np.empty((0, 2)), np.empty(0), np.empty(0))
    some = corners(np.random.default_rng(2), 5)
    assert poses_of_corners(none, some, np.zeros(3), ANYWHERE, SETTINGS) == []
    assert poses_of_corners(some, none, np.zeros(3), ANYWHERE, SETTINGS) == []


def test_a_turned_room_is_found_whichever_way_it_was_turned() -> None:
    rng = np.random.default_rng(3)
    known = corners(rng, 10)
    for turn in np.linspace(-3, 3, 7):
        turned = PlacedCorners(known.positions @ rotation(-turn).T, known.turns, wrap(known.headings - turn))
        best = poses_of_corners(known, turned, np.zeros(3), ANYWHERE, SETTINGS)[0]
        np.testing.assert_allclose(best, [0, 0, turn], atol=1e-9)
