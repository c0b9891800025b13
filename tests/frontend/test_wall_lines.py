import numpy as np
import pytest
from shapely import box

from frontend.scan import Floats
from frontend.wall_lines import Profile, wall_beside
from tests.frontend.rooms import true_ranges, turn

BEARINGS = turn(256)
ROOM = box(-2, -2, 3, 2.4)
CORNER = float(np.arctan2(2.4, 3))


def measured_up_to(degrees: float, noise: float = 0.0) -> Profile:
    """The room from its inside, with nothing measured so near to one corner."""
    ranges, _ = true_ranges(ROOM, np.zeros(3), BEARINGS)
    noisy = ranges + np.random.default_rng(0).normal(0.0, noise, 256)
    return Profile(BEARINGS, noisy, np.abs(BEARINGS - CORNER) > np.radians(degrees))


@pytest.mark.parametrize("sense", [1, -1])
def test_a_wall_is_continued_to_a_corner_from_either_side(sense: int) -> None:
    place = int(np.argmin(np.abs(BEARINGS - CORNER)))
    wall = wall_beside(measured_up_to(12), place, sense, 0.01)
    assert wall is not None
    ranges, spread = wall.ranges(np.array([CORNER]))
    assert np.isclose(ranges[0], np.hypot(3, 2.4), atol=1e-6)
    assert spread[0] > 0


@pytest.mark.parametrize("seed", range(5))
def test_the_spread_says_how_far_off_the_continued_wall_is(seed: int) -> None:
    rng = np.random.default_rng(seed)
    exact = measured_up_to(12)
    place = int(np.argmin(np.abs(BEARINGS - CORNER)))
    off: Floats = np.empty(0)
    for _ in range(20):
        profile = Profile(BEARINGS, exact.ranges + rng.normal(0.0, 0.01, 256), exact.measured)
        wall = wall_beside(profile, place, 1, 0.01)
        assert wall is not None
        ranges, spread = wall.ranges(np.array([CORNER]))
        off = np.append(off, (ranges[0] - np.hypot(3, 2.4)) / spread[0])
    assert 0.4 < np.sqrt(np.mean(off**2)) < 2.0


def test_beams_that_turn_away_from_a_wall_never_meet_it() -> None:
    wall = wall_beside(measured_up_to(12), int(np.argmin(np.abs(BEARINGS - CORNER))), -1, 0.01)
    assert wall is not None
    ranges, spread = wall.ranges(np.array([np.pi]))
    assert np.isinf(ranges).all()
    assert np.isinf(spread).all()


def test_too_few_readings_make_no_wall() -> None:
    profile = measured_up_to(12)
    few = Profile(BEARINGS, profile.ranges, profile.measured & (np.arange(256) % 4 < 3))
    assert wall_beside(few, 128, 1, 0.01) is None
