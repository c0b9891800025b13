"""The factor graph: poses and landmarks tied by what was measured between them, solved by GTSAM.

gtsam stays behind this door; keys are plain indices, poses are (3,) arrays, covariances (3, 3) in the moving frame's
axes.
"""

from copy import copy
from dataclasses import dataclass

import gtsam
import numpy as np
from gtsam.symbol_shorthand import L, W, X, Y
from numpy.typing import NDArray

from backend.estimate import LandmarkTie, Tie

Floats = NDArray[np.float64]


ONE = 2e-3  # metres and radians by which two landmarks that are one may lie apart: less than anything measures


class GraphError(Exception):
    """A factor names a pose or landmark that the graph does not hold."""


@dataclass(frozen=True)
class GraphSettings:
    """How the graph is solved."""

    loop_width: float = 1.0  # Cauchy width of a loop's residual in sigmas; larger trusts doubtful loops more
    landmark_width: float = 1.345  # Huber width of a sighting's residual in sigmas; larger trusts outliers more
    square: float = np.radians(1.0)  # by which walls are built askew; larger trusts the building less
    square_width: float = 2.0  # Cauchy width of that, in sigmas; larger bends walls more that are not square
    iterations: int = 60  # of the final solve at most; more refines further
    settled: float = 1e-4  # relative fall of the error that ends it; larger stops earlier


class FactorGraph:
    """Grows by factors; `mend` moves the estimates that are touched by the newest ones, `solve` all of them."""

    def __init__(self, settings: GraphSettings) -> None:
        self.settings = settings
        self._graph = gtsam.NonlinearFactorGraph()
        self._values = gtsam.Values()
        self._tree = gtsam.ISAM2(_tree_parameters())
        self._taken = 0  # factors the tree already holds
        self._fresh = gtsam.Values()  # values it does not
        self._loops: list[tuple[int, int, gtsam.Pose2, Floats]] = []
        self._poses: list[int] = []
        self._anchors: dict[int, int] = {}  # pose, and the place of its factor
        self.landmark_indices: list[int] = []
        self._walls: list[int] = []
        self._stays: dict[int, int] = {}  # wall, and the place of the factor that keeps it from sliding
        self._first_seen: dict[int, int] = {}  # wall, and the pose that saw it first
        self._directions: dict[int, int] = {}  # direction, and the first wall that stands square to it
        self._ties: list[tuple[int, int, Floats, Floats]] = []
        self._sightings: list[tuple[int, int, Floats, Floats]] = []

    @property
    def poses(self) -> Floats:
        """(n, 3) current estimates, in the order they were added."""
        walls_first = gtsam.utilities.extractPose2(self._values).reshape(-1, 3)  # then poses, directions last
        return np.asarray(walls_first[len(self._walls) :][_ranks(self._poses)])

    @property
    def walls(self) -> Floats:
        """(w, 3) current frames of the walls, in the order they were added."""
        walls_first = gtsam.utilities.extractPose2(self._values).reshape(-1, 3)
        return np.asarray(walls_first[: len(self._walls)][_ranks(self._walls)])

    @property
    def directions(self) -> Floats:
        """(d,) headings of the directions of walls, in the order they were added."""
        return np.array([self._values.atPose2(Y(k)).theta() for k in range(len(self._directions))])

    @property
    def landmarks(self) -> Floats:
        """(l, 2) current estimates, in the order they were added."""
        sorted_by_index = gtsam.utilities.extractPoint2(self._values).reshape(-1, 2)
        return np.asarray(sorted_by_index[_ranks(self.landmark_indices)])

    @property
    def ties(self) -> list[Tie]:
        """Every motion and loop."""
        information = _information(np.array([tie[3] for tie in self._ties]).reshape(-1, 3, 3))
        return [Tie(*tie[:3], known) for tie, known in zip(self._ties, information, strict=True)]

    @property
    def landmark_ties(self) -> list[LandmarkTie]:
        """Every sighting, its landmark by its place in `landmarks`."""
        place = {index: k for k, index in enumerate(self.landmark_indices)}
        information = _information(np.array([seen[3] for seen in self._sightings]).reshape(-1, 2, 2))
        return [
            LandmarkTie(pose, place[index], position, known)
            for (pose, index, position, _), known in zip(self._sightings, information, strict=True)
        ]

    def add_pose(self, index: int, pose: Floats) -> None:
        """A new pose at its first guess (3,)."""
        self._insert(X(index), gtsam.Pose2(*pose))
        self._poses.append(index)

    def anchor(self, index: int, pose: Floats, covariance: Floats) -> None:
        """A pose is known from outside: the first one, or the start of a session."""
        self._check_pose(index)
        self._anchors[index] = self._graph.size()
        self._graph.add(gtsam.PriorFactorPose2(X(index), gtsam.Pose2(*pose), _noise(covariance)))

    def add_motion(self, fixed: int, moving: int, pose: Floats, covariance: Floats) -> None:
        """`moving` was seen or driven to be at `pose` (3,) in the frame of `fixed`."""
        self._add_between(fixed, moving, pose, _noise(covariance))
        self._ties.append((fixed, moving, pose, covariance))

    def add_loop(self, fixed: int, moving: int, pose: Floats, covariance: Floats) -> None:
        """As `add_motion`, but it may be wrong: it loses its weight when the rest of the graph contradicts it."""
        self._check_pose(fixed)
        self._check_pose(moving)
        cauchy = gtsam.noiseModel.mEstimator.Cauchy.Create(self.settings.loop_width)
        information = _information(covariance)
        self._loops.append((fixed, moving, gtsam.Pose2(*pose), information))
        self._add_between(fixed, moving, pose, gtsam.noiseModel.Robust.Create(cauchy, _noise(covariance)))
        self._ties.append((fixed, moving, pose, covariance))

    def add_landmark(self, index: int, position: Floats) -> None:
        """A new landmark at its first guess (2,)."""
        self._insert(L(index), np.asarray(position, float))
        self.landmark_indices.append(index)

    def add_sighting(self, pose: int, landmark: int, position: Floats, covariance: Floats) -> None:
        """Landmark seen at `position` (2,) in the frame of `pose`, covariance (2, 2): a bearing-range factor."""
        self._check_pose(pose)
        if not self._values.exists(L(landmark)):
            raise GraphError(
                f"a sighting names landmark {landmark}, but the graph holds {len(self.landmark_indices)} landmarks"
            )
        distance = float(np.hypot(*position))
        if distance == 0:
            raise GraphError(f"landmark {landmark} is seen where pose {pose} stands itself: that has no bearing")
        along = position / distance
        turned = np.array([[-along[1], along[0]], along]) / np.array([[distance], [1.0]])
        noise = self._huber(turned @ covariance @ turned.T)
        bearing = gtsam.Rot2(float(np.arctan2(position[1], position[0])))
        self._graph.add(gtsam.BearingRangeFactor2D(X(pose), L(landmark), bearing, distance, noise))
        self._sightings.append((pose, landmark, position, covariance))

    def add_wall(self, index: int, frame: Floats) -> None:
        """A new wall at its first guess: a frame (3,) that lies on it, heads into it, and may slide along it."""
        self._insert(W(index), gtsam.Pose2(*frame))
        self._walls.append(index)
        self._stays[index] = self._graph.size()
        self._graph.add(_stay(index, gtsam.Pose2(*frame)))

    def add_wall_sighting(self, pose: int, wall: int, frame: Floats, covariance: Floats) -> None:
        """The wall's frame was seen at `frame` (3,) in the frame of `pose`, covariance (3, 3) in the wall's axes."""
        self._check_pose(pose)
        noise = self._huber(covariance)
        self._graph.add(gtsam.BetweenFactorPose2(X(pose), W(wall), gtsam.Pose2(*frame), noise))
        self._first_seen.setdefault(wall, pose)

    def add_direction(self, index: int, heading: float) -> None:
        """A new direction of walls at its first guess: the next index. Its place means nothing, and stays."""
        there = gtsam.Pose2(0.0, 0.0, heading)
        self._insert(Y(index), there)
        self._directions[index] = -1
        self._graph.add(gtsam.PriorFactorPose2(Y(index), there, _noise(np.diag([1.0, 1.0, 1e6]))))

    def add_square(self, wall: int, direction: int, turns: int) -> None:
        """The wall heads `turns` quarter turns from a direction, unless the rest of the graph contradicts it."""
        if self._directions[direction] < 0:
            self._directions[direction] = wall
        cauchy = gtsam.noiseModel.mEstimator.Cauchy.Create(self.settings.square_width)
        noise = gtsam.noiseModel.Robust.Create(cauchy, _noise(np.diag([1e6, 1e6, self.settings.square]) ** 2))
        turned = gtsam.Pose2(0.0, 0.0, turns * np.pi / 2)
        self._graph.add(gtsam.BetweenFactorPose2(Y(direction), W(wall), turned, noise))

    def unite_walls(self, wall: int, other: int) -> None:
        """Two walls are one: they lie in a line."""
        frames = [self._values.atPose2(W(index)) for index in (wall, other)]
        along = gtsam.Pose2(0.0, frames[0].transformTo(frames[1].translation())[1], 0.0)
        self._graph.add(gtsam.BetweenFactorPose2(W(wall), W(other), along, _noise(np.diag([ONE, 1e6, ONE]) ** 2)))

    def unite_landmarks(self, landmark: int, other: int) -> None:
        """Two landmarks are one: they lie in one place."""
        self._graph.add(gtsam.BetweenFactorPoint2(L(landmark), L(other), np.zeros(2), _noise(np.eye(2) * ONE**2)))

    def belief(self, pose: int, walls: list[int], landmarks: list[int]) -> tuple[Floats, Floats]:
        """Mean (d,), joint covariance (d, d) of a pose, walls (3 each), landmarks (2 each), all in the room's axes."""
        frames = [self._values.atPose2(key) for key in (X(pose), *map(W, walls))]
        points = [self._values.atPoint2(L(index)) for index in landmarks]
        keys = [X(pose), *map(W, walls), *map(L, landmarks)]
        own = gtsam.Marginals(self._graph, self._values).jointMarginalCovariance(keys)
        joint = np.block([[own.at(first, second) for second in keys] for first in keys])
        turns = np.eye(len(joint))
        for k, frame in enumerate(frames):
            turns[3 * k : 3 * k + 2, 3 * k : 3 * k + 2] = frame.rotation().matrix()
        mean = [value for frame in frames for value in (frame.x(), frame.y(), frame.theta())]
        return np.array([*mean, *np.array(points).ravel()]), np.asarray(turns @ joint @ turns.T)

    def mend(self) -> None:
        """Let the incremental solver (ISAM2) take in what is new."""
        graph = gtsam.NonlinearFactorGraph()
        for k in range(self._taken, self._graph.size()):
            graph.add(self._graph.at(k))
        self._taken = self._graph.size()
        self._tree.update(graph, self._fresh)
        self._fresh = gtsam.Values()
        self._values = self._tree.calculateEstimate()

    def believe(self, newest: int) -> None:
        """Take the newest so many loops at their word, once; `solve` then starts where they hold.

        A robust kernel lets go of what is far off, however sure it is: a drive closed late would stay half open.
        """
        at_their_word = gtsam.NonlinearFactorGraph(self._graph)
        for fixed, moving, pose, information in self._loops[-newest:]:
            noise = gtsam.noiseModel.Gaussian.Information(information)
            at_their_word.add(gtsam.BetweenFactorPose2(X(fixed), X(moving), pose, noise))
        self._values = self._best(at_their_word, self.settings.settled)

    def solve(self, settled: float | None = None) -> None:
        """Levenberg–Marquardt from the current estimates, where the incremental solver starts again.

        settled: the relative fall of the error that ends it, where that of the settings is too coarse.
        """
        self._values = self._best(self._graph, settled or self.settings.settled)
        self._tree, self._taken, self._fresh = gtsam.ISAM2(_tree_parameters()), 0, gtsam.Values(self._values)

    def carry(self, poses: dict[int, Floats], freed: int) -> None:
        """Poses (3,) are believed elsewhere, what was first seen from them goes along, and `freed` loses its anchor.

        What then ties them must be added, and all solved.
        """
        moved = {index: gtsam.Pose2(*pose) for index, pose in poses.items()}
        first: dict[int, int] = {}
        for pose, landmark, *_ in self._sightings:
            first.setdefault(landmark, pose)
        for landmark, pose in first.items():
            if pose in moved:
                seen = self._values.atPose2(X(pose)).transformTo(self._values.atPoint2(L(landmark)))
                self._values.update(L(landmark), moved[pose].transformFrom(seen))
        self._carry_walls(moved)
        for index, there in moved.items():
            self._values.update(X(index), there)
        gone, kept = self._anchors.pop(freed), gtsam.NonlinearFactorGraph()
        for k in range(self._graph.size()):
            if k != gone:
                kept.add(self._graph.at(k))
        self._graph = kept
        for places in (self._anchors, self._stays):
            places.update({index: place - (place > gone) for index, place in places.items()})

    def _carry_walls(self, moved: dict[int, gtsam.Pose2]) -> None:
        """Walls go along with the pose that saw them first, directions with the wall that was held to them first."""
        turned = {}
        for wall, pose in self._first_seen.items():
            if pose in moved:
                before = self._values.atPose2(W(wall))
                frame = moved[pose].compose(self._values.atPose2(X(pose)).between(before))
                self._values.update(W(wall), frame)
                self._graph.replace(self._stays[wall], _stay(wall, frame))
                turned[wall] = gtsam.Pose2(0.0, 0.0, frame.theta() - before.theta())
        for direction, wall in self._directions.items():
            if wall in turned:
                self._values.update(Y(direction), self._values.atPose2(Y(direction)).compose(turned[wall]))

    def solved(self) -> "FactorGraph":
        """The same factors with everything at its best; this graph keeps the estimates it has."""
        best = copy(self)
        best.solve()
        return best

    def loop_residuals(self) -> list[tuple[int, int, float]]:
        """(fixed, moving, residual in sigmas) of every loop at the current estimate."""
        found = []
        for fixed, moving, measured, information in self._loops:
            here = self._values.atPose2(X(fixed)).between(self._values.atPose2(X(moving)))
            error = measured.localCoordinates(here)
            found.append((fixed, moving, float(np.sqrt(error @ information @ error))))
        return found

    def covariances(self) -> Floats:
        """(n, 3, 3) marginal covariances of the poses in their own axes."""
        if self._poses and not self._anchors:
            raise GraphError(f"{len(self._poses)} poses, but no anchor: nothing says where they are")
        marginals = gtsam.Marginals(self._graph, self._values)
        return np.array([marginals.marginalCovariance(X(i)) for i in self._poses]).reshape(-1, 3, 3)

    def _best(self, graph: gtsam.NonlinearFactorGraph, settled: float) -> gtsam.Values:
        parameters = gtsam.LevenbergMarquardtParams()
        parameters.setMaxIterations(self.settings.iterations)
        parameters.setRelativeErrorTol(settled)
        parameters.setlambdaInitial(1e-6)
        return gtsam.LevenbergMarquardtOptimizer(graph, self._values, parameters).optimize()

    def _huber(self, covariance: Floats) -> gtsam.noiseModel.Base:
        huber = gtsam.noiseModel.mEstimator.Huber.Create(self.settings.landmark_width)
        return gtsam.noiseModel.Robust.Create(huber, _noise(covariance))

    def _insert(self, key: int, value: gtsam.Pose2 | Floats) -> None:
        self._values.insert(key, value)
        self._fresh.insert(key, value)

    def _add_between(self, fixed: int, moving: int, pose: Floats, noise: gtsam.noiseModel.Base) -> None:
        self._check_pose(fixed)
        self._check_pose(moving)
        self._graph.add(gtsam.BetweenFactorPose2(X(fixed), X(moving), gtsam.Pose2(*pose), noise))

    def _check_pose(self, index: int) -> None:
        if not self._values.exists(X(index)):
            raise GraphError(f"a factor names pose {index}, but the graph holds {len(self._poses)} poses")


def _tree_parameters() -> gtsam.ISAM2Params:
    parameters = gtsam.ISAM2Params()
    parameters.setRelinearizeThreshold(0.05)  # metres or radians; the solve at the end is exact
    parameters.relinearizeSkip = 1
    return parameters


def _stay(wall: int, frame: gtsam.Pose2) -> gtsam.PriorFactorPose2:
    """Nothing ties the place of a wall's frame along the wall, so it stays where it is."""
    return gtsam.PriorFactorPose2(W(wall), frame, _noise(np.diag([1e6, 1.0, 1e6])))


def _noise(covariance: Floats) -> gtsam.noiseModel.Base:
    return gtsam.noiseModel.Gaussian.Covariance(np.asarray(covariance, float))


def _information(covariance: Floats) -> Floats:
    return np.asarray(np.linalg.inv(covariance), np.float64)


def _ranks(indices: list[int]) -> NDArray[np.int64]:
    """The place (n,) of each index when they are sorted, as gtsam keeps its values."""
    return np.argsort(np.argsort(np.array(indices, np.int64)))
