"""Doors seen in several scans: the views report their jambs where all sightings together put them."""

import numpy as np

from frontend.door_edges import DoorEdgeSettings
from frontend.fusion import FusionSettings
from frontend.rigid_motion import transform
from frontend.scan import Floats
from slam.door_tracking import sharpened_views
from slam.perception import FrontendSettings, Percept, perceive
from tests.frontend.test_fusion import FEET, INCH, door_scan

JAMBS = np.array([[6 * FEET, -15 * INCH], [6 * FEET, 15 * INCH]])


def seen_from(poses: Floats) -> list[Percept]:
    settings = FrontendSettings(fusion=FusionSettings())
    return [perceive(door_scan(256, (pose[0], pose[1], pose[2]))[0], settings) for pose in poses]


def off_the_jambs(openings: list[Floats], poses: Floats) -> Floats:
    placed = [transform(jambs.reshape(-1, 2), pose) for jambs, pose in zip(openings, poses, strict=True)]
    return np.asarray(np.min(np.linalg.norm(np.concatenate(placed)[:, None] - JAMBS[None], axis=2), axis=1))


def test_views_of_one_door_agree_on_its_jambs_better_than_each_alone() -> None:
    rng = np.random.default_rng(4)
    poses = np.column_stack([rng.uniform(-0.6, 0.4, 8), rng.uniform(-0.4, 0.4, 8), np.zeros(8)])
    percepts = seen_from(poses)
    believed = poses + np.column_stack([rng.normal(0, 0.03, (8, 2)), np.zeros(8)])
    doubt = np.tile(np.diag([0.03, 0.03, 0.005]) ** 2, (8, 1, 1))
    views, edges = sharpened_views(percepts, believed, doubt, DoorEdgeSettings())
    door = np.sort(edges.sightings)[-2:]
    assert np.all(door >= 6)
    alone = off_the_jambs([percept.view.openings for percept in percepts], believed)
    together = off_the_jambs([view.openings for view in views], believed)
    near = alone < 0.3
    assert np.mean(together[near]) < np.mean(alone[near])


def test_a_view_without_a_door_stays_as_it_is() -> None:
    percepts = seen_from(np.array([[-2.5, 0.0, 0.0]]))
    assert not len(percepts[0].fused.openings)
    views, edges = sharpened_views(percepts, np.zeros((1, 3)), np.zeros((1, 3, 3)), DoorEdgeSettings())
    assert views[0].openings.shape == (0, 2, 2)
    assert edges.positions.shape == (0, 2)
