"""All settings of one run, composed from the dataclasses that stand beside their users."""

from dataclasses import dataclass, field

from backend.polygon_merging import MergeSettings
from slam.mapper import MapperSettings
from slam.perception import FrontendSettings
from slam.planning import PlanningSettings


@dataclass(frozen=True)
class Settings:
    """One branch per part; a TOML file names what differs from these defaults."""

    frontend: FrontendSettings = field(default_factory=FrontendSettings)
    poses: MapperSettings = field(default_factory=MapperSettings)
    merging: MergeSettings = field(default_factory=MergeSettings)
    planning: PlanningSettings = field(default_factory=PlanningSettings)
