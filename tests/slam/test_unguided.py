"""A scan that nothing guides: found where it stands out, refused where it does not, said where it may slide."""

import numpy as np
import pytest
from shapely import box

from frontend.local_map import LocalMap
from frontend.registration import Guess, RegistrationSettings
from frontend.rigid_motion import between, compose
from frontend.scan import Floats, Scan
from frontend.sensors.lidar import LIDAR
from frontend.visibility import VisibilitySettings
from slam.perception import FrontendSettings, perceive
from slam.simulation.record import lidar_scan
from slam.simulation.world import World
from slam.unguided import Looked, Unguided, UnguidedSettings, place_unguided
from tests.simulated_drives import BEARINGS, corridor, faces_from, furnished_room, world_of

SETTINGS = UnguidedSettings()
SIGMAS = np.array([0.5, 0.5, 0.3])


def looked(world: World, seen_from: list[Floats], pose: Floats, rng: np.random.Generator) -> Looked:
    ranges = lidar_scan(world, pose, LIDAR, rng)
    percept = perceive(Scan(BEARINGS, ranges, LIDAR, np.zeros(3), 0.0), FrontendSettings())
    faces = faces_from(world, seen_from, rng)
    return Looked(percept, LocalMap.of(faces), RegistrationSettings(), VisibilitySettings())


def placed(here: Looked, guess: Floats, sigmas: Floats = SIGMAS) -> Unguided:
    window = (3 * float(sigmas[0]), min(3 * float(sigmas[2]), np.pi))
    return place_unguided(here, Guess(guess, np.diag(1 / sigmas**2)), window, SETTINGS)


@pytest.mark.parametrize("seed", range(6))
def test_a_scan_is_found_a_metre_and_a_quarter_turn_off(seed: int) -> None:
    rng = np.random.default_rng(seed)
    world, last = furnished_room(rng), np.array([2.3, 2.4, 0.2])
    true = compose(last, np.array([rng.uniform(0, 0.6), 0.0, rng.uniform(-0.7, 0.7)]))
    found = placed(looked(world, [last], true, rng), compose(true, np.array([-0.9, 0.3, 0.8])))
    assert found.refused is None
    assert found.slid is None
    off = between(true, found.laid.found.pose_in_fixed)
    assert np.hypot(*off[:2]) < 0.02
    assert abs(off[2]) < 0.01


def test_along_a_corridor_it_lies_where_it_was_expected_and_says_so() -> None:
    rng = np.random.default_rng(1)
    true, guess = np.array([30.0, 1.0, 0.0]), np.array([30.5, 1.1, 0.1])
    found = placed(looked(corridor(), [true - [0.6, 0, 0]], true, rng), guess)
    assert found.refused is None
    assert found.slid is not None
    assert "along the corridor nothing is known" in found.slid
    pose, covariance = found.laid.found.pose_in_fixed, np.linalg.inv(found.laid.found.information)
    assert pose[0] == pytest.approx(30.5, abs=0.05)
    assert pose[1] == pytest.approx(1.0, abs=0.02)
    assert np.sqrt(covariance[0, 0]) > 0.5
    assert np.sqrt(covariance[1, 1]) < 0.02


def test_a_scan_of_another_room_is_refused() -> None:
    rng = np.random.default_rng(2)
    here, last = looked(furnished_room(rng), [np.array([2.3, 2.4, 0.2])], np.array([2.5, 2.4, 0.4]), rng), np.zeros(3)
    elsewhere = looked(corridor(), [np.array([30.0, 1.0, 0.5])], np.array([30.0, 1.0, 0.5]), rng)
    lost = placed(Looked(elsewhere.percept, here.local_map, here.registration, here.visibility), last)
    assert lost.refused is not None
    assert "needed" in lost.refused


def test_a_square_room_looks_the_same_in_four_directions_and_nothing_is_guessed() -> None:
    rng = np.random.default_rng(3)
    middle = np.array([2.5, 2.5, 0.0])
    here = looked(world_of(box(0, 0, 5, 5)), [middle], middle, rng)
    wide = np.array([0.5, 0.5, 2.0])
    doubted = placed(here, compose(middle, np.array([0, 0, np.pi / 4])), wide)
    assert doubted.refused is not None
    assert "lies as well" in doubted.refused
    assert placed(here, compose(middle, np.array([0, 0, 0.2]))).refused is None


def test_the_more_places_are_tried_the_better_the_one_must_be() -> None:
    """New ground fills half of this scan: enough beside where the robot was, not where it was lost."""
    rng = np.random.default_rng(4)
    world = world_of(box(0, 0, 12, 5), box(5.9, 0, 6.1, 3.6))
    here = looked(world, [np.array([3.0, 4.2, 0.0])], np.array([6.0, 4.3, 0.2]), rng)
    near = placed(here, np.array([5.6, 4.2, 0.0]))
    far = placed(here, np.array([5.6, 4.2, 0.0]), 4 * SIGMAS)
    assert near.refused is None
    assert near.laid.fit < SETTINGS.believed + 2 * SETTINGS.rise
    assert far.refused is not None
