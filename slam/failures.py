"""Everything that can go wrong with what a user gives us: each of these is one sentence, and no bug of ours.

They are listed by name, for their modules hold all stages between them: whoever mistyped is not made to wait for those.
"""

import sys
from importlib import import_module

ERRORS = (
    ("backend.polygon_merging", "MergingError"),
    ("frontend.registration", "RegistrationError"),
    ("frontend.scan", "ScanError"),
    ("planners.path", "PlanningError"),
    ("planners.robot", "RobotError"),
    ("planners.world", "WorldError"),
    ("slam.checkpoint", "CheckpointError"),
    ("slam.exports.product", "ExportError"),
    ("slam.readers.recording", "RecordingError"),
    ("slam.result_folder", "ResultError"),
    ("slam.room_file", "RoomFileError"),
    ("slam.scores.boundaries", "MapScoreError"),
    ("slam.scores.trajectories", "RelationsError"),
    ("slam.serve.door", "DoorError"),
    ("slam.simulation.record", "SimulationError"),
    ("slam.simulation.world", "PlanError"),
    ("slam.toml_file", "TomlFileError"),
    ("slam.trajectory_file", "TrajectoryFileError"),
    ("slam.whole_output", "OutputError"),
)


def all_failures() -> tuple[type[Exception], ...]:
    """The classes; loads every module that has one."""
    return PermissionError, *(getattr(import_module(module), name) for module, name in ERRORS)


def is_foreseen(failure: Exception) -> bool:
    """Whether `failure` is one of them; only those whose module is loaded can have been raised.

    A PermissionError is: whatever it names lies where this user may not look.
    """
    raised = (getattr(sys.modules[module], name) for module, name in ERRORS if module in sys.modules)
    return isinstance(failure, (PermissionError, *raised))
