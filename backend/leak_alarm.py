"""The wall-leak alarm: surface that views measured inside the final free space, and why the merge let it go.

It needs no truth. What more views saw through than measured is free in the map; the order in which they did says
whether something moved.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely import MultiPolygon

from backend.leak_repair import BIN, FaceBins, leaking
from backend.samples import Samples
from backend.seen_through import Beams, seers

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def alarms(
    free: MultiPolygon, bins: FaceBins, samples: Samples, beams: Beams, depth: float
) -> tuple[Floats, tuple[tuple[Ints, Ints], ...]]:
    """Middles (l, 2) of the pieces of face deeper than `depth` metres inside the free space, and of each piece the
    views that measured it and those that saw through it, by row."""
    found = leaking(free, bins, depth)
    surface = cKDTree(samples.points)
    point, seer = seers(found, bins, beams, depth)
    views = []
    for number, (middle, normal) in enumerate(zip(found.middles, found.normals, strict=True)):
        near = np.array(surface.query_ball_point(middle, 0.5 * BIN + depth), dtype=np.int64)
        measured = np.unique(samples.view[near[samples.normals[near] @ normal > 0.5]])
        views.append((measured, np.setdiff1d(seer[point == number], measured)))
    return found.middles, tuple(views)


def why(measured: Ints, through: Ints) -> str:
    """In words, why a piece of surface that views measured is free in the map; views by index, in order of time."""
    said = f"{len(measured)} views measured it, {len(through)} saw through it"
    if not len(measured) or not len(through):
        return f"{said}: too short a piece to stand against the votes around it"
    if measured.max() < through.min():
        return f"{said}: it stood there until view {measured.max()} and was gone from view {through.min()} on"
    if measured.min() > through.max():
        return f"{said}: it came after view {through.max()}"
    during = through[(through > measured.min()) & (through < measured.max())]
    if not len(during):
        return f"{said}: it was there only from view {measured.min()} to view {measured.max()}"
    return f"{said}, {len(during)} of them in between: glass, a mesh, a door that swings, or poses that disagree"
