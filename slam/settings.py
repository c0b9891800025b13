"""All settings of one run, composed from the dataclasses that stand beside their users."""

from dataclasses import dataclass, field, replace

from backend.polygon_merging import MergeSettings
from frontend.door_edges import DoorEdgeSettings
from slam.mapper_settings import MapperSettings
from slam.perception import FrontendSettings
from slam.planning import PlanningSettings
from slam.readers.recording import OdometryNoise


@dataclass(frozen=True)
class Settings:
    """One branch per part; a TOML file names what differs from these defaults."""

    frontend: FrontendSettings = field(default_factory=FrontendSettings)
    poses: MapperSettings = field(default_factory=MapperSettings)
    door_edges: DoorEdgeSettings = field(default_factory=DoorEdgeSettings)
    merging: MergeSettings = field(default_factory=MergeSettings)
    planning: PlanningSettings = field(default_factory=PlanningSettings)


def knowing(settings: Settings, wheels: OdometryNoise | None) -> Settings:
    """The settings with what the recording says of its robot's wheels: a measured fact outweighs an opinion."""
    if wheels is None:
        return settings
    odometry = replace(
        settings.poses.odometry,
        distance_noise=wheels.distance_noise,
        turn_noise=wheels.turn_noise,
        turn_per_metre=wheels.turn_per_metre_noise,
    )
    return replace(settings, poses=replace(settings.poses, odometry=odometry))
