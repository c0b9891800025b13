"""Samples: measured surface points of many views, each with its facing side and the view it came from."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Samples:
    """Points and unit normals towards the sensor (n, 2); view (n,) the row of its view; sigma, weight (n,) in metres.

    sure: (n,) whether the normal is to be believed.
    """

    points: Floats
    normals: Floats
    view: Ints
    sigma: Floats
    weight: Floats
    sure: NDArray[np.bool_]

    def placed(self, poses: Floats) -> "Samples":
        """Samples in the frames of their views, put at the poses (v, 3) of these."""
        heading = poses[self.view, 2]
        cosine, sine = np.cos(heading), np.sin(heading)
        points, normals = (
            np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=1)
            for x, y in ((self.points[:, 0], self.points[:, 1]), (self.normals[:, 0], self.normals[:, 1]))
        )
        return replace(self, points=points + poses[self.view, :2], normals=normals)

    def thinned(self, spacing: float) -> "Samples":
        """One sample for about every `spacing` metres of each view's surface; the total weight stays."""
        first = np.append(0, np.flatnonzero(np.diff(self.view)) + 1) if len(self.view) else np.empty(0, dtype=np.int64)
        total = np.cumsum(self.weight)
        before = np.repeat(total[first] - self.weight[first], np.diff(np.append(first, len(self.view))))
        steps = np.floor((total - before) / spacing) - np.floor((total - before - self.weight) / spacing)
        return replace(self, weight=steps * spacing).where(steps > 0)

    def about(self, points: Floats, size: float) -> NDArray[np.bool_]:
        """Whether the samples (n,) lie in the same cells of `size` metres as points (m, 2), or beside these."""
        if not len(points):
            return np.zeros(len(self.points), dtype=np.bool_)
        low = points.min(axis=0) - 2 * size
        shape = np.ceil((points.max(axis=0) + 2 * size - low) / size).astype(np.int64)
        near = np.zeros(shape, dtype=np.bool_)
        near[tuple(((points - low) / size).astype(np.int64).T)] = True
        near = ndimage.binary_dilation(near, np.ones((3, 3), dtype=np.bool_))
        cell = np.floor((self.points - low) / size).astype(np.int64)
        inside: NDArray[np.bool_] = np.all((cell >= 0) & (cell < shape), axis=1)
        inside[inside] = near[tuple(cell[inside].T)]
        return inside

    def where(self, chosen: NDArray[np.bool_]) -> "Samples":
        """The samples for which `chosen` (n,) holds."""
        points, normals, view = self.points[chosen], self.normals[chosen], self.view[chosen]
        return Samples(points, normals, view, self.sigma[chosen], self.weight[chosen], self.sure[chosen])
