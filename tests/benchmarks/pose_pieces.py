"""What poses owe to each piece of sensor and method: fewer beams, shorter and noisier ranges, one piece left out.

The settings are those of every other log, but for the piece that is left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from frontend.scan import Scan
from slam.mapper_settings import MapperSettings
from slam.settings import Settings

Spoil = Callable[[Scan, np.random.Generator], Scan]


def every_other_beam(scan: Scan, _: np.random.Generator) -> Scan:
    """Half of the beams, twice as far apart."""
    return replace(scan, bearings=scan.bearings[::2], ranges=scan.ranges[::2])


def five_metres(scan: Scan, _: np.random.Generator) -> Scan:
    """A sensor that sees nothing beyond 5 m."""
    return replace(
        scan, ranges=np.where(scan.ranges > 5.0, np.inf, scan.ranges), sensor=replace(scan.sensor, max_range=5.0)
    )


def three_centimetres(scan: Scan, rng: np.random.Generator) -> Scan:
    """A sensor whose ranges scatter by 3 cm more, and that says so."""
    scattered = scan.ranges + rng.normal(0, 0.03, scan.ranges.size)
    noise = float(np.hypot(scan.sensor.range_noise, 0.03))
    return replace(scan, ranges=scattered, sensor=replace(scan.sensor, range_noise=noise))


# What is spoilt, how, and the mean translation error in metres that may be left.
POORER_SENSORS: tuple[tuple[str, Spoil, float], ...] = (
    ("90 of 180 beams", every_other_beam, 0.025),
    ("range cut to 5 m", five_metres, 0.025),
    ("3 cm range noise", three_centimetres, 0.024),
)


def spoilt(scans: Sequence[Scan], spoil: Spoil) -> list[Scan]:
    """All scans, each spoilt, with one seed."""
    rng = np.random.default_rng(0)
    return [spoil(scan, rng) for scan in scans]


# What is left out of the estimation, and how.
POSES = Settings().poses
ABLATIONS: tuple[tuple[str, MapperSettings], ...] = (
    (
        "the wheels' calibration",
        replace(POSES, odometry=replace(POSES.odometry, scale_doubt=0.0, bias_doubt=0.0, mount_doubt=0.0)),
    ),
    ("knots as landmarks", replace(POSES, landmarks=replace(POSES.landmarks, proven=10**9))),
    ("constellations", replace(POSES, constellations=replace(POSES.constellations, proposals=0))),
    ("the wider search", replace(POSES, tracking=replace(POSES.tracking, good=0.0, poor=0.0))),
    ("loops", replace(POSES, loops=replace(POSES.loops, skipped=10**9))),
    ("the last step over all faces", replace(POSES, refinement=replace(POSES.refinement, cells=()))),
)
