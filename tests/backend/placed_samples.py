"""Samples and settled views of known plans, for the tests of faces and of settling."""

import numpy as np
import shapely
from numpy.typing import NDArray

from backend.samples import Samples
from backend.seen_through import Beams, beams_of
from backend.sight import sight_of
from backend.surfaces import surfaces_of
from backend.view import View

Floats = NDArray[np.float64]


def local_samples(views: list[View]) -> Samples:
    """Sure samples of all views in their own frames."""
    parts = [surfaces_of(view, 0.1, 0.01) for view in views]
    samples = Samples(
        np.concatenate([part.ring[part.corner] for part in parts]),
        np.concatenate([part.normals for part in parts]),
        np.repeat(np.arange(len(parts)), [len(part.corner) for part in parts]),
        np.concatenate([part.sigma for part in parts]),
        np.concatenate([part.weight for part in parts]),
        np.concatenate([part.sure for part in parts]),
    )
    return samples.where(samples.sure)


def wall_samples(start: Floats, end: Floats, views: int, noise: float, rng: np.random.Generator) -> Samples:
    """Samples every 5 cm on a wall, free space on the left of start → end, each view with its own offset."""
    along = (end - start) / np.linalg.norm(end - start)
    normal = np.array([-along[1], along[0]])
    steps = np.arange(0.0, np.linalg.norm(end - start), 0.05)
    offsets = rng.normal(0, noise, views)
    points = start + np.tile(steps, views)[:, None] * along + np.repeat(offsets, len(steps))[:, None] * normal
    count = len(points)
    view = np.repeat(np.arange(views), len(steps))
    sigma, weight = np.full(count, 0.01), np.full(count, 0.05)
    return Samples(points, np.tile(normal, (count, 1)), view, sigma, weight, np.ones(count, dtype=bool))


def joined(*parts: Samples) -> Samples:
    """All samples together."""
    return Samples(
        np.concatenate([part.points for part in parts]),
        np.concatenate([part.normals for part in parts]),
        np.concatenate([part.view for part in parts]),
        np.concatenate([part.sigma for part in parts]),
        np.concatenate([part.weight for part in parts]),
        np.concatenate([part.sure for part in parts]),
    )


def beams_to(rings: list[Floats], origins: Floats) -> Beams:
    """Beams from origins (v, 2) that end every 5 cm or closer on the rings (m, 2)."""
    dense = [shapely.get_coordinates(shapely.segmentize(shapely.Polygon(ring), 0.05))[:-1] for ring in rings]
    return beams_of(sight_of(rings, origins), dense)
