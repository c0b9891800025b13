"""Laws of sight: it says what the polygons say."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Polygon

from backend.sight import sight_of
from backend.view import place
from tests.backend.plan_rays import Rays, furnished_plan, scattered_poses, view_of


@given(st.integers(0, 1000), st.sampled_from([np.pi, 1.5 * np.pi, 2 * np.pi]))
@settings(deadline=None, max_examples=12)
def test_sight_agrees_with_the_polygons(seed: int, field: float) -> None:
    rng = np.random.default_rng(seed)
    plan = furnished_plan(rng, 3)
    poses = scattered_poses(plan, 5, rng)
    views = [view_of(plan, pose, Rays(beams=120, field=field), rng) for pose in poses]
    rings = [place(view.boundary, pose) for view, pose in zip(views, poses, strict=True)]
    points = rng.uniform(-1, 9, (400, 2))
    point, view = sight_of(rings, poses[:, :2]).pairs(points)
    told = np.zeros((400, 5), dtype=bool)
    told[point, view] = True
    truth = np.stack([shapely.contains_xy(Polygon(ring), points) for ring in rings], axis=1)
    assert np.mean(told == truth) > 0.999
    assert np.all(np.diff(point) >= 0)
