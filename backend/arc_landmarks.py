"""Landmarks of range arcs: walls and edges that arcs of several scans agree on, tied into the factor graph.

A new scan is placed by the landmarks it sees again; arcs that nothing explains wait until others agree with them.
"""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from backend.arc_association import AssociationSettings, Belief, Known, Placement, associate
from backend.arc_births import Birth, BirthSettings, Loose, births
from backend.arcs import Arcs, seen_wall
from backend.doubled_landmarks import Doubles, DoubleSettings, doubled
from backend.factor_graph import FactorGraph
from backend.odometry import Move
from backend.square_walls import SquareSettings, SquareWalls

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class ArcLandmarkSettings:
    """How landmarks of arcs are found and found again."""

    association: AssociationSettings = field(default_factory=AssociationSettings)
    births: BirthSettings = field(default_factory=BirthSettings)
    doubles: DoubleSettings = field(default_factory=DoubleSettings)
    square: SquareSettings = field(default_factory=SquareSettings)
    reach: float = 5.5  # metres around the robot in which landmarks are looked for; larger looks farther
    fresh: int = 15  # scans since a landmark was seen after which to see it again is a loop; larger doubts fewer
    revisits: int = 2  # such landmarks a scan must recognise at once; larger refuses more loops
    waiting: int = 6  # scans an arc waits for others; larger finds landmarks that are rarely seen


@dataclass(frozen=True)
class Reunion:
    """What a pose saw looked like landmarks of before. poses: that saw those last, rising, and the newest; united:
    whether they are one from now on; reason: why, or why not."""

    poses: tuple[int, ...]
    united: bool
    reason: str


@dataclass(frozen=True)
class _Landmark:
    """index: among the graph's walls or landmarks. seen: the newest pose that did. start, stop: of a wall, as far as it
    was seen, leftward of its origin. ray: heading of the ray that first met an edge."""

    wall: bool
    index: int
    seen: int = 0
    start: float = 0.0
    stop: float = 0.0
    ray: float = 0.0


class ArcLandmarks:
    """Grows with the graph: `place` a scan before its pose is added, let it `see` afterwards."""

    def __init__(self, settings: ArcLandmarkSettings) -> None:
        self.settings = settings
        self._landmarks: list[_Landmark] = []
        self._seen_by: list[set[int]] = []  # the poses that saw each landmark
        self._gone: set[int] = set()  # landmarks that were another one
        self._counts: dict[bool, list[int]] = {True: [], False: []}
        self._waiting: list[tuple[int, Arcs, int]] = []  # pose, and which of its arcs
        self._square = SquareWalls(settings.square)

    @property
    def counts(self) -> Integers:
        """How often each edge was seen, (l,), in the order of the graph's landmarks."""
        return np.array(self._counts[False], np.int64)

    def forget(self) -> None:
        """What follows was taken elsewhere: nothing of it may be recognised by what was seen so far."""
        self._landmarks.clear()
        self._seen_by.clear()
        self._gone.clear()
        self._waiting.clear()
        self._square.forget()

    def place(self, graph: FactorGraph, last: int, move: Move, arcs: Arcs) -> tuple[Placement, list[int]]:
        """Where a scan lies after `move` from the pose `last`, and which landmarks its pairs mean."""
        near = self._near(graph, last)
        placement = self._associated(graph, last, move, arcs, near)
        fresh = [k for k in near if last - self._landmarks[k].seen < self.settings.fresh]
        revisited = {which for _, which in placement.pairs} - {near.index(k) for k in fresh}
        if 0 < len(revisited) < self.settings.revisits:
            # One old landmark alone may be mistaken, and would bend the whole round: loops need company.
            return self._associated(graph, last, move, arcs, fresh), fresh
        return placement, near

    def _associated(self, graph: FactorGraph, last: int, move: Move, arcs: Arcs, near: list[int]) -> Placement:
        walls, edges = self._of_graph(near)
        belief = _moved(Belief(*graph.belief(last, walls, edges)), move)
        known = [self._known(k, walls, edges) for k in near]
        return associate(belief, known, arcs, self.settings.association)

    def see(self, graph: FactorGraph, pose: int, arcs: Arcs, placement: Placement, near: list[int]) -> None:
        """Tie the newest pose, already in the graph, to what it saw; what nothing explains waits."""
        for arc, which in placement.pairs:
            self._tie(graph, pose, arcs, arc, near[which])
        for arc in placement.loose:
            if arcs.firm[arc]:
                self._tie(graph, pose, arcs, arc, self._new_wall(graph, placement.pose, arcs, arc))
            else:
                self._waiting.append((pose, arcs, arc))
        self._waiting = [one for one in self._waiting if pose - one[0] <= self.settings.waiting]

    def square(self, graph: FactorGraph) -> None:
        """Hold walls that were seen often enough, and solved, to stand square to others."""
        self._square.see(graph, np.array(self._counts[True], np.int64))

    def unite(self, graph: FactorGraph, pose: int) -> Reunion | None:
        """Make one what the newest pose saw and turned out to be landmarks of before; None if nothing is like them."""
        near = self._near(graph, pose)
        pairs = [
            (elder, younger)
            for younger in range(len(near))
            if self._landmarks[near[younger]].seen == pose
            for elder in range(len(near))
            if self._may_be_one(near[elder], near[younger])
        ]
        if not pairs:
            return None
        walls, edges = self._of_graph(near)
        known = [self._known(k, walls, edges) for k in near]
        found = doubled(Belief(*graph.belief(pose, walls, edges)), known, pairs, self.settings.doubles)
        return None if found is None else self._decided(graph, pose, found, near)

    def _decided(self, graph: FactorGraph, pose: int, found: Doubles, near: list[int]) -> Reunion:
        pairs = [(near[elder], near[younger]) for elder, younger in found.pairs]
        before = sorted({self._landmarks[elder].seen for elder, _ in pairs} - {pose})
        if found.one:
            for elder, younger in pairs:
                self._unite(graph, elder, younger)
        return Reunion((*before, pose), found.one, found.reason)

    def _may_be_one(self, elder: int, younger: int) -> bool:
        """What one scan saw beside each other is two."""
        seen, again = self._seen_by[elder], self._seen_by[younger]
        alike = self._landmarks[elder].wall == self._landmarks[younger].wall
        return alike and min(seen) < min(again) and seen.isdisjoint(again)

    def _unite(self, graph: FactorGraph, elder: int, younger: int) -> None:
        ours, theirs = self._landmarks[elder], self._landmarks[younger]
        if ours.wall:
            frames = graph.walls[[ours.index, theirs.index]]
            along = float((frames[1, :2] - frames[0, :2]) @ [-np.sin(frames[0, 2]), np.cos(frames[0, 2])])
            ours = replace(ours, start=min(ours.start, theirs.start + along), stop=max(ours.stop, theirs.stop + along))
            graph.unite_walls(ours.index, theirs.index)
        else:
            graph.unite_landmarks(ours.index, theirs.index)
        self._landmarks[elder] = replace(ours, seen=max(ours.seen, theirs.seen))
        self._seen_by[elder] |= self._seen_by[younger]
        self._gone.add(younger)

    def conceive(self, graph: FactorGraph, pose: int, turn: float) -> None:
        """Bear what the waiting arcs agree on. turn: radians by which the newest heading is in doubt."""
        if not self._waiting:
            return
        waiting, poses = self._waiting, graph.poses
        loose = _loose(waiting, poses)
        born: set[int] = set()
        for birth in births(loose, pose, turn, self.settings.births):
            landmark = self._born(graph, loose, birth)
            for member in birth.members:
                seen_from, arcs, arc = waiting[member]
                self._tie(graph, seen_from, arcs, arc, landmark)
            born.update(int(member) for member in birth.members)
        self._waiting = [one for k, one in enumerate(waiting) if k not in born]

    def _near(self, graph: FactorGraph, last: int) -> list[int]:
        """Landmarks within reach of the last pose: edges by their place, walls by their distance."""
        place, walls, edges = graph.poses[last, :2], graph.walls, graph.landmarks
        away = {
            True: np.abs(np.sum((walls[:, :2] - place) * _normals(walls[:, 2]), axis=1)),
            False: np.linalg.norm(edges - place, axis=1),
        }
        return [
            k
            for k, one in enumerate(self._landmarks)
            if k not in self._gone and away[one.wall][one.index] < self.settings.reach
        ]

    def _of_graph(self, near: list[int]) -> tuple[list[int], list[int]]:
        """Which of the graph's walls, and which of its other landmarks, these are."""
        ones = [self._landmarks[k] for k in near]
        return [one.index for one in ones if one.wall], [one.index for one in ones if not one.wall]

    def _known(self, landmark: int, walls: list[int], edges: list[int]) -> Known:
        one = self._landmarks[landmark]
        slot = 3 + 3 * walls.index(one.index) if one.wall else 3 + 3 * len(walls) + 2 * edges.index(one.index)
        return Known(one.wall, slot, one.start, one.stop, one.ray)

    def _new_wall(self, graph: FactorGraph, pose: Floats, arcs: Arcs, arc: int) -> int:
        """A wall that one arc shows surely, its origin at the foot."""
        heading = pose[2] + arcs.wall_bearings[arc]
        foot = pose[:2] + arcs.ranges[arc] * np.array([np.cos(heading), np.sin(heading)])
        return self._add_wall(graph, np.array([*foot, heading]))

    def _born(self, graph: FactorGraph, loose: Loose, birth: Birth) -> int:
        if not birth.wall:
            index = len(self._counts[False])
            graph.add_landmark(index, birth.values)
            ray = birth.values - loose.places[birth.members[-1]]
            return self._add(_Landmark(False, index, ray=float(np.arctan2(ray[1], ray[0]))))
        heading, distance = birth.values
        normal, place = np.array([np.cos(heading), np.sin(heading)]), loose.places[birth.members[-1]]
        return self._add_wall(graph, np.array([*(place + normal * (distance - normal @ place)), heading]))

    def _add_wall(self, graph: FactorGraph, frame: Floats) -> int:
        index = len(self._counts[True])
        graph.add_wall(index, frame)
        return self._add(_Landmark(True, index, 0, np.inf, -np.inf))

    def _add(self, landmark: _Landmark) -> int:
        self._landmarks.append(landmark)
        self._seen_by.append(set())
        self._counts[landmark.wall].append(0)
        return len(self._landmarks) - 1

    def _tie(self, graph: FactorGraph, pose: int, arcs: Arcs, arc: int, landmark: int) -> None:
        one = self._landmarks[landmark]
        self._counts[one.wall][one.index] += 1
        self._seen_by[landmark].add(pose)
        if not one.wall:
            graph.add_sighting(pose, one.index, *arcs.sighted_edge(arc))
            self._landmarks[landmark] = replace(one, seen=pose)
            return
        along = seen_wall(graph.poses[pose], graph.walls[one.index])[2]
        graph.add_wall_sighting(pose, one.index, *arcs.sighted_wall(arc, along))
        start, stop = along + float(arcs.starts[arc]), along + float(arcs.stops[arc])
        self._landmarks[landmark] = _Landmark(True, one.index, pose, min(one.start, start), max(one.stop, stop))


def _moved(belief: Belief, move: Move) -> Belief:
    """The belief after the pose made a move (3,) in its own frame, covariance (3, 3) in the axes it started from."""
    x, y, heading = belief.mean[:3]
    cosine, sine = np.cos(heading), np.sin(heading)
    axes = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    step = axes @ move.pose
    slope = np.eye(len(belief.mean))
    slope[:2, 2] = -step[1], step[0]
    covariance = slope @ belief.covariance @ slope.T
    covariance[:3, :3] += axes @ move.covariance @ axes.T
    mean = belief.mean.copy()
    mean[:3] = x + step[0], y + step[1], heading + step[2]
    return Belief(mean, covariance)


def _loose(waiting: list[tuple[int, Arcs, int]], poses: Floats) -> Loose:
    """The waiting arcs as columns, placed at the poses (n, 3) that saw them."""
    owner = np.array([pose for pose, _, _ in waiting], np.int64)
    columns = np.array(
        [
            (
                arcs.ranges[k], arcs.wall_bearings[k], arcs.wall_spreads[k], arcs.starts[k], arcs.stops[k],
                arcs.edge_bearings[k], arcs.edge_spreads[k], arcs.rising[k],
            )
            for _, arcs, k in waiting
        ]
    ).T  # fmt: skip
    headings = poses[owner, 2]
    return Loose(
        owner, poses[owner, :2], columns[0], waiting[0][1].spread, columns[1] + headings, columns[2], columns[3],
        columns[4], columns[5] + headings, columns[6], columns[7] > 0,
    )  # fmt: skip


def _normals(headings: Floats) -> Floats:
    return np.column_stack([np.cos(headings), np.sin(headings)])
