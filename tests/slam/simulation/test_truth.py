import json

import numpy as np
import shapely
from shapely.geometry import shape

from frontend.rigid_motion import transform
from slam.simulation.plans import PLANS
from slam.simulation.truth import truth_geojson
from slam.simulation.world import build_world


def test_the_truth_is_the_plan_seen_from_the_first_pose() -> None:
    world = build_world(PLANS["flynn_basement"]())
    first = np.array([2.0, 1.0, 0.7])
    features = json.loads(truth_geojson(world, first))["features"]
    free = shape(features[0]["geometry"])
    back = shapely.transform(free, lambda points: transform(points, first))
    assert back.symmetric_difference(world.free).area < 0.01
    kinds = [part["properties"]["kind"] for part in features]
    assert kinds.count("free") == 1
    assert kinds.count("obstacle") == 3
    assert [part["properties"]["name"] for part in features if part["properties"]["kind"] == "door"] == [
        "left door", "front door", "right door",
    ]  # fmt: skip
