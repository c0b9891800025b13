"""Samples: measured surface points of many views, each with its facing side and the view it came from."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

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

    def where(self, chosen: NDArray[np.bool_]) -> "Samples":
        """The samples for which `chosen` (n,) holds."""
        points, normals, view = self.points[chosen], self.normals[chosen], self.view[chosen]
        return Samples(points, normals, view, self.sigma[chosen], self.weight[chosen], self.sure[chosen])
