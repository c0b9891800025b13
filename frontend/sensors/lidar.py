"""The lidar: one thin beam per bearing, with range noise and lost readings."""

import numpy as np

from frontend.scan import Floats, Sensor
from frontend.sensors.rays import cast
from frontend.sensors.surfaces import Surfaces

LIDAR = Sensor(kind="lidar", min_range=0.05, max_range=12.0, half_beam=0.0, range_noise=0.015, quantum=0.001)
DROPOUT = 0.005  # share of readings lost for no reason of the room


def lidar_ranges(
    surfaces: Surfaces, pose: Floats, bearings: Floats, sensor: Sensor, rng: np.random.Generator
) -> Floats:
    """Ranges (n,) read at bearings (n,) from `pose` (3,); `inf` beyond the reach or lost."""
    distances, _ = cast(surfaces, pose[:2], pose[2] + bearings)
    noisy = distances + rng.normal(0.0, sensor.range_noise, distances.size)
    read = np.round(noisy / sensor.quantum) * sensor.quantum if sensor.quantum > 0 else noisy
    lost = (rng.random(distances.size) < DROPOUT) | (distances < sensor.min_range) | ~(read <= sensor.max_range)
    return np.asarray(np.where(lost, np.inf, np.maximum(read, sensor.min_range)))
