"""Refining: scans between keyframes are laid on the walls like all others, and the wheels hold what nobody sees."""

from itertools import pairwise

import numpy as np

from backend.joint_refinement import RefinementSettings
from backend.odometry import Move, Odometry, OdometrySettings
from frontend.rigid_motion import between, compose
from frontend.scan import Scan
from frontend.sensors.lidar import LIDAR
from slam.perception import FrontendSettings, perceive
from slam.refining import refined, wheels_say
from slam.simulation.record import lidar_scan
from tests.simulated_drives import BEARINGS, furnished_room

TRUE = np.array([compose(np.array([2.0, 2.0, 0.1]), np.array([0.1 * k, 0.02 * k, 0.04 * k])) for k in range(8)])


def test_scans_off_by_centimetres_come_back_to_the_walls() -> None:
    rng = np.random.default_rng(0)
    world = furnished_room(rng)
    scans = [Scan(BEARINGS, lidar_scan(world, pose, LIDAR, rng), LIDAR, pose, 0.0) for pose in TRUE]
    percepts = [perceive(scan, FrontendSettings()) for scan in scans]
    wheels = Odometry(OdometrySettings())
    moves = [wheels_say(wheels, old, new) for old, new in pairwise(percepts)]
    off = rng.normal(0, 1, TRUE.shape) * [0.02, 0.02, 0.005]
    off[0] = 0
    found = refined(TRUE + off, percepts, moves, RefinementSettings())
    assert np.max(np.abs(found - TRUE)[:, :2]) < 0.01
    np.testing.assert_array_equal(found[0], TRUE[0])


def test_a_single_scan_stays_where_it_is() -> None:
    silent = perceive(Scan(BEARINGS, np.full(BEARINGS.size, np.inf), LIDAR, TRUE[0], 0.0), FrontendSettings())
    np.testing.assert_array_equal(refined(TRUE[:1], [silent], [], RefinementSettings()), TRUE[:1])


def test_the_wheels_say_the_move_between_two_scans_in_the_axes_of_the_second() -> None:
    rng = np.random.default_rng(1)
    old, new = (
        perceive(Scan(BEARINGS, rng.uniform(1, 2, BEARINGS.size), LIDAR, pose, 0.0), FrontendSettings())
        for pose in (np.zeros(3), np.array([1.0, 0.0, np.pi / 2]))
    )
    move = wheels_say(Odometry(OdometrySettings(scale_doubt=0, bias_doubt=0, mount_doubt=0)), old, new)
    assert isinstance(move, Move)
    np.testing.assert_allclose(move.pose, between(np.zeros(3), np.array([1.0, 0.0, np.pi / 2])), atol=1e-9)
    np.testing.assert_allclose(np.diag(move.covariance)[:2], 0.06**2)
