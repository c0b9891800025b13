"""Tracking by arcs: a scan of a wide beam is placed by the walls and edges it hears again, not by its smeared outline.

The outline still gives a first guess where it lies well on what was just seen.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from backend.arc_association import Placement
from backend.arc_landmarks import ArcLandmarks, ArcLandmarkSettings, Reunion
from backend.arcs import Arcs
from backend.factor_graph import FactorGraph
from backend.odometry import Move
from frontend.local_map import Faces, LocalMap
from frontend.registration import Guess, RegistrationSettings, register
from frontend.rigid_motion import between, compose, wrap
from frontend.scan import Floats, Integers
from frontend.surface import Surface
from slam.tracking import turned


@dataclass(frozen=True)
class ArcTrackingSettings:
    """How arcs place a scan, and when the outline may say where to look for them."""

    landmarks: ArcLandmarkSettings = field(default_factory=ArcLandmarkSettings)
    registration: RegistrationSettings = field(default_factory=RegistrationSettings)
    recent: int = 6  # keyframes that the outline is laid on; larger bridges more occlusion
    reach: float = 20.0  # metres of them around the robot
    matched: float = 0.5  # share of the outline that must lie on them; larger guesses less often
    gate: float = 12.0  # squared distance from the wheels' claim (χ², 3 degrees of freedom, 0.7 %)
    metres: float = 0.04  # what the guess is worth: a smeared outline is laid no better; larger trusts it less
    radians: float = np.radians(1.5)
    settled: float = 1e-7  # relative fall of the error that ends a solve: where arcs are few, a little moves far
    least_faces: int = 8  # surface points on either side of a guess


class Followed(NamedTuple):
    """Where a scan was put (3,), how surely (3, 3, in its own axes), how many landmarks it was recognised by, and what
    was decided about new ones that look like those of before."""

    pose: Floats
    covariance: Floats
    recognised: int
    reunion: Reunion | None


class ArcTracking:
    """Places the scans of one drive, and ties them into the graph."""

    def __init__(self, settings: ArcTrackingSettings) -> None:
        self.settings = settings
        self._landmarks = ArcLandmarks(settings.landmarks)

    @property
    def counts(self) -> Integers:
        """How often each edge was seen, (l,), in the order of the graph's landmarks."""
        return self._landmarks.counts

    def start(self, graph: FactorGraph, number: int, arcs: Arcs) -> None:
        """The scan of pose `number`, already in the graph, begins a drive: it stands in a frame of its own."""
        self._landmarks.forget()
        alone = Placement(graph.poses[number], np.zeros((3, 3)), (), tuple(range(len(arcs.ranges))))
        self._landmarks.see(graph, number, arcs, alone, [])

    def follow(self, graph: FactorGraph, arcs: Arcs, surface: Surface, recent: list[Faces], move: Move) -> Followed:
        """Add the pose after `move` from the newest one, and solve."""
        poses = graph.poses
        number, last = len(poses), poses[-1]
        likely = self._likely(surface, recent, last, move)
        placement, near = self._landmarks.place(graph, number - 1, likely, arcs)
        graph.add_pose(number, placement.pose)
        graph.add_motion(number - 1, number, move.pose, turned(move.covariance, -move.pose[2]))
        self._landmarks.see(graph, number, arcs, placement, near)
        turn = float(np.sqrt(min(move.covariance[2, 2], placement.covariance[2, 2])))
        self._landmarks.conceive(graph, number, turn)
        graph.solve(self.settings.settled)
        self._landmarks.square(graph)
        reunion = self._landmarks.unite(graph, number)
        if reunion is not None and reunion.united:
            graph.solve(self.settings.settled)
        covariance = turned(placement.covariance, -placement.pose[2])
        return Followed(graph.poses[number], covariance, len(placement.pairs), reunion)

    def _likely(self, surface: Surface, recent: list[Faces], last: Floats, move: Move) -> Move:
        """The move from the pose `last` (3,) that the outline laid on recent ones and the wheels agree on; that of the
        wheels where the outline says little or contradicts them."""
        settings, claimed = self.settings, compose(last, move.pose)
        faces = Faces.together(recent).facing(claimed[:2], settings.reach)
        if min(len(faces.points), len(surface.points)) < settings.least_faces:
            return move
        worth = np.diag([settings.metres, settings.metres, settings.radians]) ** 2
        start = Guess(claimed, np.asarray(np.linalg.inv(turned(move.covariance, last[2]))))
        found = register(surface, LocalMap.of(faces), start, settings.registration)
        offset = between(last, found.pose_in_fixed) - move.pose
        offset[2] = float(wrap(offset[2]))
        gain = move.covariance @ np.linalg.inv(move.covariance + worth)
        if found.matched < settings.matched or offset @ np.linalg.solve(move.covariance, offset) > settings.gate:
            return move
        return Move(move.pose + gain @ offset, move.covariance - gain @ move.covariance)
