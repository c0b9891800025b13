"""The Intel building with worse sensors, worse wheels and lies: how much of the poses' rightness is left.

The settings are those of every other log.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from backend.estimate import Estimate
from frontend.scan import Floats, Scan
from slam.mapper import Mapper, MapperSettings
from slam.settings import Settings

FALSE_SHARE = 0.2  # of all loops

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


def a_tenth_too_far(scan: Scan, _: np.random.Generator) -> Scan:
    """Wheels that claim a tenth more way than there was."""
    return replace(scan, odometry=scan.odometry * [1.1, 1.1, 1.0])


# What is spoilt, how, and the mean translation error in metres that may be left.
STRESSES: tuple[tuple[str, Spoil, float], ...] = (
    ("90 of 180 beams", every_other_beam, 0.025),
    ("range cut to 5 m", five_metres, 0.025),
    ("3 cm range noise", three_centimetres, 0.024),
    ("odometry a tenth too long", a_tenth_too_far, 0.025),
)


def spoilt(scans: Sequence[Scan], spoil: Spoil) -> list[Scan]:
    """All scans, each spoilt, with one seed."""
    rng = np.random.default_rng(0)
    return [spoil(scan, rng) for scan in scans]


def with_false_loops(scans: Sequence[Scan]) -> Estimate:
    """The estimate where a share of all loops ties the newest keyframe to some other one, at a pose that is made up."""
    settings, rng = Settings(), np.random.default_rng(0)
    mapper = _Lied(settings, rng)
    for scan in scans:
        mapper.add(scan)
    return mapper.result()


class _Lied(Mapper):
    """A mapper that is told false loops besides those it finds."""

    def __init__(self, settings: Settings, rng: np.random.Generator) -> None:
        super().__init__(settings.frontend, settings.poses)
        believe = self._graph.add_loop

        def add_loop(fixed: int, moving: int, pose: Floats, covariance: Floats) -> None:
            believe(fixed, moving, pose, covariance)
            if rng.random() < FALSE_SHARE / (1 - FALSE_SHARE):
                false = np.array([*rng.uniform(-3, 3, 2), rng.uniform(-np.pi, np.pi)])
                believe(int(rng.integers(moving)), moving, false, covariance)

        self._graph.add_loop = add_loop  # type: ignore[method-assign]


# What is left out of the estimation, and how.
POSES = Settings().poses
ABLATIONS: tuple[tuple[str, MapperSettings], ...] = (
    (
        "the wheels' calibration",
        replace(POSES, odometry=replace(POSES.odometry, scale_doubt=0.0, bias_doubt=0.0, mount_doubt=0.0)),
    ),
    ("knots as landmarks", replace(POSES, landmarks=replace(POSES.landmarks, proven=10**9))),
    ("the wider search", replace(POSES, tracking=replace(POSES.tracking, good=0.0, poor=0.0))),
    ("loops", replace(POSES, loops=replace(POSES.loops, skipped=10**9))),
    ("the last step over all faces", replace(POSES, refinement=replace(POSES.refinement, cells=()))),
)
