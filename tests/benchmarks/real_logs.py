"""Real lidar logs as the front end sees them, with the true moves between their scans.

The logs lie in the folder that ROOMSKETCH_DATA names.
"""

import os
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from frontend.contour import Contour, ContourSettings, trace
from frontend.fusion import FusionSettings, fuse
from frontend.primal_sketch import PrimalSketch, SketchSettings, sketch
from frontend.scan import Floats, Scan
from slam.recordings import open_recording
from slam.trajectory_file import read_trajectory
from tests.benchmarks.true_moves import true_moves


@dataclass(frozen=True, eq=False)
class RealLog:
    """Scans of a log, and the poses (n, 3) that another system made of it."""

    scans: list[Scan]
    poses: Floats

    @cached_property
    def contours(self) -> list[Contour]:
        """The contour of each scan."""
        return [trace(fuse(scan, FusionSettings()), ContourSettings()) for scan in self.scans]

    @cached_property
    def sketches(self) -> list[PrimalSketch]:
        """The sketch of each scan."""
        return [sketch(contour, SketchSettings()) for contour in self.contours]

    @cached_property
    def moves(self) -> list[Floats | None]:
        """Pose (3,) of each scan but the first in the frame of the one before; None where it is in doubt."""
        return true_moves([contour.surface() for contour in self.contours], self.poses)


@cache
def real_log(name: str, first: int, last: int) -> RealLog:
    """Scans first to last of a log."""
    folder = Path(os.environ["ROOMSKETCH_DATA"]) / name
    scans = list(open_recording(folder / f"{name}.log.gz").scans)[first : last + 1]
    return RealLog(scans, read_trajectory(folder / "particle_filter_poses.tum").poses[first : last + 1])
