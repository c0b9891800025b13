import numpy as np
from shapely import box, union_all

from frontend.fusion import FusionSettings, ReadingKind, fuse
from frontend.scan import Floats, Scan, Sensor
from tests.frontend.rooms import first_echoes, true_ranges, turn

FEET, INCH = 0.3048, 0.0254
SENSOR = Sensor(
    "sonar_infrared", max_range=35 * FEET, half_beam=np.radians(20), range_noise=0.003, infrared_range=10 * FEET
)
ROOM = union_all([
    box(-4, -3, 6 * FEET, 3),
    box(6 * FEET - 0.1, -15 * INCH, 6 * FEET + 0.1, 15 * INCH),
    box(6 * FEET + 0.02, -3, 12, 3),
])  # fmt: skip


def door_scan(n: int = 256, pose: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> tuple[Scan, Floats]:
    """A 30-inch door 6 ft ahead with a deep room behind it."""
    bearings = turn(n)
    truth, _ = true_ranges(ROOM, np.array(pose), bearings)
    infrared = np.where(truth < 10 * FEET, 31, 30).astype(np.int16)
    ranges = first_echoes(truth, SENSOR.half_beam)
    return Scan(bearings, ranges, SENSOR, np.zeros(3), 0.0, infrared), truth


def test_a_door_the_sonar_cannot_see_is_opened_by_the_infrared() -> None:
    scan, truth = door_scan()
    ahead = np.argmin(np.abs(scan.bearings))
    assert np.isclose(scan.ranges[ahead], np.hypot(6 * FEET, 15 * INCH), atol=0.02)
    fused = fuse(scan, FusionSettings())
    assert np.isclose(fused.ranges[ahead], 10 * FEET)
    assert fused.kinds[ahead] == ReadingKind.DOOR_ARC
    assert np.all(fused.vouched <= truth + 1e-9)
    assert np.all(fused.ranges <= truth + 0.02)  # corners are inferred


def test_the_jambs_are_found_within_one_bearing_step() -> None:
    scan, _ = door_scan()
    fused = fuse(scan, FusionSettings())
    door = next(k for k, opening in enumerate(fused.openings) if abs(opening.right.bearing) < 0.5)
    step = 2 * np.pi / 256 * np.hypot(6 * FEET, 15 * INCH)
    assert np.all(
        np.linalg.norm(fused.jambs[door] - [[6 * FEET, -15 * INCH], [6 * FEET, 15 * INCH]], axis=1) < step + 0.05
    )


def test_outside_an_opening_the_redrawn_boundary_is_the_opened_one() -> None:
    scan, _ = door_scan()
    fused = fuse(scan, FusionSettings())
    blind = fuse(Scan(scan.bearings, scan.ranges, SENSOR, np.zeros(3), 0.0), FusionSettings())
    outside = fused.kinds != ReadingKind.DOOR_ARC
    assert np.array_equal(fused.vouched[outside], blind.vouched[outside])


def test_redrawing_twice_changes_nothing() -> None:
    scan, _ = door_scan()
    once = fuse(scan, FusionSettings(beam_share=0.0))
    twice = fuse(
        Scan(scan.bearings, once.ranges, SENSOR, np.zeros(3), 0.0, scan.infrared), FusionSettings(beam_share=0.0)
    )
    assert np.allclose(once.ranges, twice.ranges)


def test_a_lone_edge_leaves_the_boundary_and_says_so() -> None:
    bearings = np.linspace(-1, 1, 81)
    infrared = np.where(bearings > 0.5, 30, 31).astype(np.int16)
    scan = Scan(bearings, np.full(81, 2.0), SENSOR, np.zeros(3), 0.0, infrared)
    fused = fuse(scan, FusionSettings())
    assert np.all(fused.ranges == 2.0)
    assert any("lone infrared edge" in reason for reason in fused.reasons.values())


def test_a_dark_wall_the_sonar_sees_is_no_door() -> None:
    bearings = turn(256)
    infrared = np.where(np.abs(bearings) < 0.8, 30, 31).astype(np.int16)
    fused = fuse(Scan(bearings, np.full(256, 2.0), SENSOR, np.zeros(3), 0.0, infrared), FusionSettings())
    assert not fused.openings
    assert any("surface" in reason for reason in fused.reasons.values())


def test_no_echo_is_a_lower_bound_and_never_a_surface() -> None:
    ranges = np.full(64, 2.0)
    ranges[20:30] = np.inf
    fused = fuse(Scan(turn(64), ranges, Sensor("lidar", 30.0), np.zeros(3), 0.0), FusionSettings(no_return_clears=1.0))
    assert np.all(fused.kinds[20:30] == ReadingKind.NO_RETURN)
    assert np.all(fused.ranges[20:30] == 1.0)


def test_a_rejected_reading_says_why_and_claims_no_more_than_its_neighbours() -> None:
    ranges = np.full(64, 2.0)
    ranges[10], ranges[11] = np.nan, 3.0
    fused = fuse(Scan(turn(64), ranges, Sensor("lidar", 30.0), np.zeros(3), 0.0), FusionSettings())
    assert fused.kinds[10] == ReadingKind.REJECTED
    assert fused.ranges[10] == 2.0
    assert fused.reasons[10] == "unusable reading"


def test_a_lone_far_reading_of_a_wide_beam_is_a_specular_loss() -> None:
    ranges = np.full(256, 2.0)
    ranges[50] = 7.0
    fused = fuse(Scan(turn(256), ranges, SENSOR, np.zeros(3), 0.0), FusionSettings())
    assert fused.kinds[50] == ReadingKind.REJECTED
    assert np.all(fused.ranges == 2.0)


def test_a_lone_far_reading_through_a_gap_that_the_infrared_finds_clear_is_no_loss() -> None:
    """20° to each side of one bearing nothing is near, so the beam of 20° passes there and there alone."""
    infrared = np.full(256, 31, dtype=np.int16)
    ranges = np.full(256, 2.0)
    ranges[100] = 7.0
    blocked = fuse(Scan(turn(256), ranges, SENSOR, np.zeros(3), 0.0, infrared), FusionSettings())
    infrared[85:116] = 30
    clear = fuse(Scan(turn(256), ranges, SENSOR, np.zeros(3), 0.0, infrared.copy()), FusionSettings())
    assert blocked.kinds[100] == ReadingKind.REJECTED
    assert clear.kinds[100] != ReadingKind.REJECTED
    assert clear.ranges[100] > 6.9


def test_a_scan_of_nothing_but_unusable_readings_claims_nothing() -> None:
    fused = fuse(Scan(turn(64), np.full(64, np.nan), Sensor("lidar", 30.0), np.zeros(3), 0.0), FusionSettings())
    assert np.all(fused.ranges <= 0.011)
