"""The settings of the mapper: those of every part of pose estimation, and when it makes keyframes and seeks loops."""

from dataclasses import dataclass, field

from backend.factor_graph import GraphSettings
from backend.joint_refinement import RefinementSettings
from backend.landmark_map import LandmarkSettings
from backend.loop_closure import LoopSettings
from backend.odometry import OdometrySettings
from frontend.corner_constellations import ConstellationSettings
from slam.arc_tracking import ArcTrackingSettings
from slam.loops import VerificationSettings
from slam.relocalisation import RelocalisationSettings
from slam.tracking import TrackingSettings


@dataclass(frozen=True)
class MapperSettings:
    """The settings of pose estimation, part by part."""

    odometry: OdometrySettings = field(default_factory=OdometrySettings)
    tracking: TrackingSettings = field(default_factory=TrackingSettings)
    loops: LoopSettings = field(default_factory=LoopSettings)
    verification: VerificationSettings = field(default_factory=VerificationSettings)
    constellations: ConstellationSettings = field(default_factory=ConstellationSettings)
    relocalisation: RelocalisationSettings = field(default_factory=RelocalisationSettings)
    arcs: ArcTrackingSettings = field(default_factory=ArcTrackingSettings)
    landmarks: LandmarkSettings = field(default_factory=LandmarkSettings)
    graph: GraphSettings = field(default_factory=GraphSettings)
    refinement: RefinementSettings = field(default_factory=RefinementSettings)
    keyframe_metres: float = 0.3  # larger keeps fewer keyframes
    keyframe_radians: float = 0.3  # larger keeps fewer keyframes
    mend_metres: float = 0.05  # disagreement of a loop that mends the graph at once; larger mends less often
    mend_radians: float = 0.01
    loop_metres: float = 1.0  # way between two searches for loops; larger searches less often
    loop_radians: float = 1.0  # turn between two searches for loops; larger searches less often
    patience: int = 3  # scans in a row that fit nowhere before the robot is lost; larger waits for people to pass
