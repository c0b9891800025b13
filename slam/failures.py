"""Everything that can go wrong with what a user gives us: each of these is one sentence, and no bug of ours."""

from backend.polygon_merging import MergingError
from frontend.registration import RegistrationError
from frontend.scan import ScanError
from planners.path import PlanningError
from planners.robot import RobotError
from planners.world import WorldError
from slam.checkpoint import CheckpointError
from slam.exports.product import ExportError
from slam.readers.recording import RecordingError
from slam.result_folder import ResultError
from slam.room_file import RoomFileError
from slam.scores.boundaries import MapScoreError
from slam.scores.trajectories import RelationsError
from slam.serve.door import DoorError
from slam.simulation.record import SimulationError
from slam.simulation.world import PlanError
from slam.toml_file import TomlFileError
from slam.trajectory_file import TrajectoryFileError
from slam.whole_output import OutputError

FAILURES = (
    CheckpointError,
    DoorError,
    ExportError,
    MapScoreError,
    MergingError,
    OutputError,
    PermissionError,  # whatever was named lies where this user may not look
    PlanError,
    PlanningError,
    RecordingError,
    RegistrationError,
    RelationsError,
    ResultError,
    RobotError,
    RoomFileError,
    ScanError,
    SimulationError,
    TomlFileError,
    TrajectoryFileError,
    WorldError,
)
