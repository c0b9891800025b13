"""Ways from a pose to the spines around it."""

import numpy as np
from shapely import box

from planners import generalized_cones
from planners.entrances import COST, NODE, ROW, entrances
from planners.generalized_cones import ConesSettings
from planners.robot import Robot
from planners.world import World

HALL = World.from_obstacles(box(0, 0, 12, 4), [box(5, 0, 7, 1.5)])
CONES = generalized_cones.prepare(HALL, Robot.rectangle(1.0, 0.5), ConesSettings())


def test_entrances_lead_to_nodes_and_cost_at_least_the_straight_way() -> None:
    pose = np.array([1.0, 2.0, np.nan])
    rows = entrances(CONES.body, CONES.slices, CONES.graph, pose, 16)
    assert rows.shape[1] == ROW
    assert len(rows)
    nodes = rows[:, NODE].astype(int)
    points = CONES.graph.stop_points[CONES.graph.node_stop[nodes]]
    assert (rows[:, COST] >= np.linalg.norm(points - pose[:2], axis=1) - 1e-9).all()


def test_more_spines_tried_give_no_fewer_entrances() -> None:
    pose = np.array([1.0, 2.0, np.nan])
    few, many = (entrances(CONES.body, CONES.slices, CONES.graph, pose, most) for most in (1, 8))
    assert len(many) >= len(few)
