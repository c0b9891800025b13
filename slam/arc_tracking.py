"""Tracking by arcs: a scan of a wide beam is placed by the walls and edges it hears again, not by its smeared outline.

The outline still gives a first guess where it lies well on what was just seen.
"""

from dataclasses import dataclass, field

import numpy as np

from backend.arc_association import Placement
from backend.arc_landmarks import ArcLandmarks, ArcLandmarkSettings
from backend.arcs import Arcs
from backend.factor_graph import FactorGraph
from backend.odometry import Move
from frontend.local_map import Faces, LocalMap
from frontend.registration import Guess, RegistrationSettings, register
from frontend.rigid_motion import compose, wrap
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
    least_faces: int = 8  # surface points on either side of a guess


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

    def follow(
        self, graph: FactorGraph, arcs: Arcs, surface: Surface, recent: list[Faces], move: Move
    ) -> tuple[Floats, Floats, int]:
        """Add the pose after `move` from the newest one, and solve; where it was put (3,), how surely (3, 3, in its own
        axes), and how many landmarks it was recognised by.
        """
        poses = graph.poses
        number, last = len(poses), poses[-1]
        guess = self._guess(surface, recent, compose(last, move.pose), turned(move.covariance, last[2]))
        placement, near = self._landmarks.place(graph, number - 1, move, arcs, guess)
        graph.add_pose(number, placement.pose)
        graph.add_motion(number - 1, number, move.pose, turned(move.covariance, -move.pose[2]))
        self._landmarks.see(graph, number, arcs, placement, near)
        turn = float(np.sqrt(min(move.covariance[2, 2], placement.covariance[2, 2])))
        self._landmarks.conceive(graph, number, turn)
        graph.solve()
        covariance = turned(placement.covariance, -placement.pose[2])
        return graph.poses[number], covariance, len(placement.pairs)

    def _guess(self, surface: Surface, recent: list[Faces], claimed: Floats, doubt: Floats) -> Move | None:
        """Where the outline lies on recent ones, in the room's axes; None where it says little or contradicts the
        claimed pose (3,) with its covariance (3, 3)."""
        settings = self.settings
        faces = Faces.together(recent).facing(claimed[:2], settings.reach)
        if min(len(faces.points), len(surface.points)) < settings.least_faces:
            return None
        worth = np.diag([settings.metres, settings.metres, settings.radians]) ** 2
        prior = doubt + worth / 4
        start = Guess(claimed, np.asarray(np.linalg.inv(prior)))
        found = register(surface, LocalMap.of(faces), start, settings.registration)
        offset = found.pose_in_fixed - claimed
        offset[2] = float(wrap(offset[2]))
        contradicts = offset @ np.linalg.solve(prior, offset) > settings.gate
        return None if found.matched < settings.matched or contradicts else Move(found.pose_in_fixed, worth)
