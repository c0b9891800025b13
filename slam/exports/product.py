"""What there is to export: the map of a run, and its trajectory and pose graph where a result folder keeps them."""

from dataclasses import dataclass
from pathlib import Path

from backend.room_map import Floats, RoomMap
from slam.result_folder import GRAPH, MAP, TRAJECTORY, read_report
from slam.room_file import points_of_kind, read_features, read_room
from slam.trajectory_file import Trajectory, read_trajectory


class ExportError(Exception):
    """What was asked for cannot be exported; the message says what is missing and how to come by it."""


@dataclass(frozen=True, eq=False)
class Product:
    """landmarks: (l, 2). trajectory and graph (g2o text) are None where only a map file is at hand."""

    source: Path
    room: RoomMap
    landmarks: Floats
    trajectory: Trajectory | None
    graph: str | None


def load_product(source: Path) -> Product:
    """From a folder that merge wrote, or from a map file alone. Raises RoomFileError or ResultError."""
    if not source.is_dir():
        return Product(source, read_room(source), _landmarks(source), None, None)
    read_report(source)
    trajectory, graph = source / TRAJECTORY, source / GRAPH
    return Product(
        source,
        read_room(source / MAP),
        _landmarks(source / MAP),
        read_trajectory(trajectory) if trajectory.exists() else None,
        graph.read_text(encoding="utf-8") if graph.exists() else None,
    )


def _landmarks(path: Path) -> Floats:
    return points_of_kind(read_features(path), "landmark")
