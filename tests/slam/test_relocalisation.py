"""Relocalisation: a robot that knows nothing of its pose is found where it stands, or not at all."""

from functools import cache

import numpy as np
import pytest

from frontend.registration import Alignment
from frontend.rigid_motion import compose, inverse
from frontend.scan import Floats
from slam.keyframes import Keyframe
from slam.loops import VerificationSettings
from slam.perception import FrontendSettings, perceive
from slam.relocalisation import RelocalisationSettings, relocalise
from slam.simulation.world import World
from tests.simulated_drives import drive, furnished_room, once_round, round_building

SETTINGS, VERIFICATION = RelocalisationSettings(), VerificationSettings()
ELSEWHERE = np.array([500.0, -300.0, 2.0])  # the frame of whoever is lost


def seen(world: World, poses: Floats, seed: int, frame: Floats) -> list[Keyframe]:
    """Keyframes at true poses (p, 3), in a frame that lies at the inverse of `frame` (3,)."""
    percepts = [perceive(scan, FrontendSettings()) for scan in drive(world, poses, seed)]
    return [
        Keyframe(number, 0, percept, compose(frame, pose))
        for number, (percept, pose) in enumerate(zip(percepts, poses, strict=True))
    ]


@cache
def old() -> list[Keyframe]:
    return seen(round_building(), once_round(step=0.6), 1, np.zeros(3))


@pytest.mark.parametrize("place", [4, 31, 57])
def test_a_lost_robot_is_found_where_it_stands(place: int) -> None:
    poses = once_round()[place : place + 4]
    found = relocalise(seen(round_building(), poses, 7, ELSEWHERE), old(), SETTINGS, VERIFICATION)
    assert isinstance(found.found, Alignment)
    off = compose(inverse(poses[-1]), found.found.pose_in_fixed)
    assert np.hypot(*off[:2]) < 0.05
    assert abs(off[2]) < 0.01
    assert np.hypot(*(old()[found.fixed].pose - poses[-1])[:2]) < 2


def test_in_another_building_it_is_found_nowhere_and_the_reason_is_said() -> None:
    poses = np.array([[2.0, 2.4, 0.0], [2.3, 2.5, 0.1]])
    room = furnished_room(np.random.default_rng(5))
    found = relocalise(seen(room, poses, 2, ELSEWHERE), old(), SETTINGS, VERIFICATION)
    assert isinstance(found.found, str)
    assert found.found
