"""Claims about the samples beside edges."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.along_edges import along_edges
from backend.samples import Samples


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000))
def test_the_same_pairs_as_asking_every_edge_about_every_sample(seed: int) -> None:
    rng = np.random.default_rng(seed)
    edges, points = rng.uniform(-3, 3, (12, 2, 2)), rng.uniform(-3, 3, (400, 2))
    angle = rng.uniform(-np.pi, np.pi, 400)
    normals, ones = np.stack([np.cos(angle), np.sin(angle)], axis=1), np.ones(400)
    found = along_edges(edges, Samples(points, normals, ones.astype(int), ones, ones, ones.astype(bool)), 0.06)
    along = edges[:, 1] - edges[:, 0]
    inward = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    near = np.array([shapely.distance(shapely.LineString(edge), shapely.points(points)) for edge in edges]) <= 0.06
    wanted = np.argwhere(near & (inward @ normals.T > 0.5))
    assert sorted(zip(found.edge.tolist(), found.sample.tolist(), strict=True)) == [tuple(pair) for pair in wanted]
    assert np.all(np.abs(found.off) <= 0.06)
    assert np.all(np.diff(found.along)[np.diff(found.edge) == 0] >= 0)
