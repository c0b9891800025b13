"""A time-of-flight ranger: a cone of light, whose first clear peak of returning photons gives the range."""

import numpy as np

from frontend.scan import Floats, Sensor
from frontend.sensors.rays import cast, incidence_cosines
from frontend.sensors.surfaces import Surfaces

# Facts of a small single-photon ranger: 27° of view, 4 m, about 1 % of noise.
TIME_OF_FLIGHT = Sensor(
    kind="time_of_flight", min_range=0.04, max_range=4.0, half_beam=np.radians(13.5), range_noise=0.02, quantum=0.001
)
RAYS = 27  # across the cone, one a degree
PULSE = 0.15  # metres that the sensor cannot tell apart: returns this close melt into one peak
FAINTEST = 0.08  # share of the strongest return a nearer one needs to be taken for the target
DARKEST = 0.4 / 4.0**2  # brightness that is just detected: a grey card at 4 m


def time_of_flight_ranges(
    surfaces: Surfaces, pose: Floats, bearings: Floats, sensor: Sensor, rng: np.random.Generator
) -> Floats:
    """Ranges (n,) read at bearings (n,) from `pose` (3,); `inf` where too few photons came back."""
    across = np.linspace(-sensor.half_beam, sensor.half_beam, RAYS)
    weight = np.cos(0.5 * np.pi * across / sensor.half_beam) + 0.1  # brighter in the middle of the cone
    angles = (pose[2] + bearings[:, None] + across).ravel()
    distances, hits = cast(surfaces, pose[:2], angles)
    cosine = incidence_cosines(surfaces, angles, hits)
    bright = np.where(hits >= 0, surfaces.reflectance[hits] * cosine, 0.0) / distances**2
    shape = (bearings.size, RAYS)
    target, total = _first_peak(distances.reshape(shape), bright.reshape(shape) * weight / weight.sum())
    noisy = target + rng.normal(0.0, sensor.range_noise, target.size)
    read = np.round(noisy / sensor.quantum) * sensor.quantum
    heard = (total >= DARKEST) & (read <= sensor.max_range)
    return np.asarray(np.where(heard, np.maximum(read, sensor.min_range), np.inf))


def _first_peak(distances: Floats, photons: Floats) -> tuple[Floats, Floats]:
    """Mean range (n,) and photons (n,) of the nearest clear group among the returns (n, rays) of each cone."""
    order = np.argsort(distances, axis=1)
    sorted_distances = np.take_along_axis(distances, order, axis=1)
    sorted_photons = np.take_along_axis(photons, order, axis=1)
    # near[n, i, j]: return j melts into the peak that begins with return i.
    gap = sorted_distances[:, None, :] - sorted_distances[:, :, None]
    near = (gap >= 0) & (gap <= PULSE)
    peaks = np.einsum("nij,nj->ni", near, sorted_photons)
    first = np.argmax(peaks >= np.maximum(FAINTEST * peaks.max(axis=1, keepdims=True), 1e-12), axis=1)
    chosen = np.take_along_axis(near, first[:, None, None], axis=1)[:, 0, :] * sorted_photons
    total = chosen.sum(axis=1)
    weighted = np.where(chosen > 0, sorted_distances, 0.0) * chosen
    return np.where(total > 0, weighted.sum(axis=1) / np.where(total > 0, total, 1.0), np.inf), total
