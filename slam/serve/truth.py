"""Truth beside the map, for the eye alone: the true plan and poses, and how far each wall edge is from the truth.

Nothing of this is read before the map is finished.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely import LineString
from shapely.geometry.base import BaseGeometry

from backend.room_map import MapEdge, MapEdgeKind, RoomMap
from frontend.scan import Floats, Scan
from slam.result_folder import plain
from slam.room_file import free_space
from slam.scores.results import map_scores, map_truth, pose_scores
from slam.serve.messages import Arrays, pack, rings_of
from slam.trajectory_file import read_trajectory

STEP = 0.05  # metres between the places where an edge is compared


@dataclass(frozen=True)
class Truth:
    """A GeoJSON plan in the frame of the first pose, and a TUM file of true poses; None where unknown."""

    plan: Path | None
    poses: Path | None

    @classmethod
    def beside(cls, recording: Path) -> "Truth":
        """What lies in a recording's folder, as the simulator puts it there."""
        plan, poses = recording / "truth.geojson", recording / "true.tum"
        return cls(plan if plan.is_file() else None, poses if poses.is_file() else None)


def truth_messages(truth: Truth, result: Path, room: RoomMap, scans: tuple[Scan, ...]) -> Iterator[bytes]:
    """The truth with the errors of every edge and pose, and the scores; nothing where nothing is known."""
    if truth.plan is None and truth.poses is None:
        return
    scores: dict[str, Any] = {}
    arrays: Arrays = {}
    if truth.plan is not None:
        free, _ = free_space(truth.plan, "free")
        arrays |= {**rings_of("true", [free]), "errors": edge_errors(room.edges, free.boundary)}
        scores |= map_scores(result, map_truth(result, truth.plan, truth.poses))
    if truth.poses is not None:
        scores["poses"] = pose_scores(result, truth.poses)
        arrays["places"] = _places(truth.poses, np.array([scan.time for scan in scans]))
    yield pack("truth", {"scores": plain(scores)}, arrays)


def edge_errors(edges: tuple[MapEdge, ...], walls: BaseGeometry) -> Floats:
    """(e,) metres: mean distance of each real edge from the nearest true wall; −1 for frontiers, which claim none."""
    lines = [LineString([edge.start, edge.end]) for edge in edges]
    shapely.prepare(walls)
    errors = np.full(len(edges), -1.0)
    for number, (edge, line) in enumerate(zip(edges, lines, strict=True)):
        if edge.kind is MapEdgeKind.REAL:
            places = shapely.points(shapely.get_coordinates(shapely.segmentize(line, STEP)))
            errors[number] = float(np.mean(shapely.distance(walls, places)))
    return errors


def _places(path: Path, times: Floats) -> Floats:
    """(n, 2) the true places at the times of the scans, nan outside the time that is known."""
    true = read_trajectory(path)
    x, y = (np.interp(times, true.times, axis, left=np.nan, right=np.nan) for axis in true.positions.T)
    return np.column_stack([x, y])
