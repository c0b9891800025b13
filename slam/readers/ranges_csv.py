"""A range table on its own: nothing is known of its sensor, so it is taken for a narrow-beamed lidar."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from frontend.scan import Sensor
from slam.readers.recording import Recording, RecordingError
from slam.readers.recording_folder import read_range_table


def read_ranges_csv(path: Path, strict: bool) -> Recording:
    """The table's scans; the farthest echo in it stands for the sensor's maximum range."""
    table = read_range_table(path, strict, Sensor("lidar", max_range=np.inf))
    echoes = np.concatenate([scan.ranges for scan in table.scans])
    farthest = float(np.max(echoes, where=np.isfinite(echoes), initial=0.0))
    if farthest == 0.0:
        raise RecordingError(f"{path}: not one echo in {len(table.scans)} scans")
    sensor = Sensor("lidar", max_range=farthest)
    return replace(table, scans=tuple(replace(scan, sensor=sensor) for scan in table.scans))
