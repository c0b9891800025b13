"""Mapping with a wide beam: every scan is a keyframe, placed by its arcs, and the factors are solved with each."""

from backend.arc_landmarks import Reunion
from backend.wheel_noise import driven
from frontend.rigid_motion import between
from frontend.scan import Floats
from slam.arc_tracking import ArcTracking
from slam.keyframes import Keyframe
from slam.mapper_settings import MapperSettings
from slam.perception import Percept
from slam.pose_graph import PoseGraph


class SonarMapping:
    """Lets a pose graph grow by the scans of a sonar that turns with the robot's centre."""

    def __init__(self, settings: MapperSettings, graph: PoseGraph) -> None:
        self.settings, self._graph = settings, graph
        self.tracking = ArcTracking(settings.arcs)

    def begin_session(self, percept: Percept) -> None:
        """The graph's newest keyframe, whose percept this is, begins a session."""
        assert percept.arcs is not None
        self.tracking.start(self._graph.factors, len(self._graph.keyframes) - 1, percept.arcs)

    def follow(self, scan: int, percept: Percept) -> Floats:
        """Place a scan by its arcs; its pose (3,)."""
        graph, old, new = self._graph, self._graph.keyframes[-1], len(self._graph.keyframes)
        assert percept.arcs is not None
        wheels = between(old.percept.scan.odometry, percept.scan.odometry)
        recent = [keyframe.faces for keyframe in graph.last(self.settings.arcs.recent)]
        pose, covariance, recognised, reunion = self.tracking.follow(
            graph.factors, percept.arcs, percept.surface, recent, driven(wheels, self.settings.odometry)
        )
        graph.add_keyframe(Keyframe(scan, old.session, percept, pose))
        graph.drift.add(new - 1, new, covariance)
        graph.move_keyframes()
        if not recognised:
            reason = f"none of its {len(percept.arcs.ranges)} walls and edges was recognised: placed by the wheels"
            graph.refuse("registration", (scan,), reason)
        if reunion is not None:
            self._record(reunion)
        return pose

    def _record(self, reunion: Reunion) -> None:
        decide = self._graph.accept if reunion.united else self._graph.refuse
        decide("double", tuple(self._graph.keyframes[pose].scan for pose in reunion.poses), reunion.reason)
