"""Doors seen in several scans: every view reports their jambs where all its sightings together put them."""

from collections.abc import Sequence
from dataclasses import replace

from backend.view import View
from frontend.door_edges import DoorEdges, DoorEdgeSettings, DoorEdgeTracks
from frontend.rigid_motion import inverse, transform
from frontend.scan import Floats
from slam.perception import Percept
from slam.tracking import turned


def sharpened_views(
    percepts: Sequence[Percept], poses: Floats, covariances: Floats, settings: DoorEdgeSettings
) -> tuple[list[View], DoorEdges]:
    """The views of percepts seen from poses (m, 3), their openings moved onto the tracked jambs, and these jambs.

    covariances: (m, 3, 3) of the poses, each in its own axes.
    """
    tracks = DoorEdgeTracks(settings)
    placed = list(zip(percepts, poses, covariances, strict=True))
    followed = [tracks.add(p.fused, pose, turned(doubt, float(pose[2]))) for p, pose, doubt in placed]
    edges = tracks.result
    views = []
    for percept, pose, numbers in zip(percepts, poses, followed, strict=True):
        jambs = transform(edges.positions[numbers], inverse(pose)).reshape(-1, 2, 2)
        views.append(replace(percept.view, openings=jambs) if len(jambs) else percept.view)
    return views, edges
