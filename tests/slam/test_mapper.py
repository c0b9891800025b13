"""The mapper: a lidar drive round a building closes its loop, whatever the wheels or some scans get wrong."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.stats import chi2

from backend.estimate import Estimate
from frontend.rigid_motion import between
from frontend.scan import Floats, Scan
from frontend.sensors.lidar import LIDAR
from slam.mapper import Mapper
from slam.settings import Settings
from slam.simulation.record import lidar_scan
from slam.simulation.trajectory import WheelNoise, in_first_frame
from tests.simulated_drives import drive, furnished_room, once_round, round_building

SETTINGS = Settings()
TRUE = in_first_frame(once_round())


@pytest.fixture(scope="module")
def scans() -> list[Scan]:
    return drive(round_building(), once_round(), seed=1)


def mapped(scans: list[Scan]) -> Estimate:
    mapper = Mapper(SETTINGS.frontend, SETTINGS.poses)
    for scan in scans:
        mapper.add(scan)
    return mapper.result()


@pytest.fixture(scope="module")
def estimate(scans: list[Scan]) -> Estimate:
    return mapped(scans)


def errors(estimate: Estimate) -> Floats:
    """Errors (n, 3) of the poses in their own axes."""
    return np.array([between(true, pose) for true, pose in zip(TRUE, estimate.poses, strict=True)])


def off(estimate: Estimate) -> Floats:
    return np.asarray(np.hypot(*errors(estimate).T[:2]))


def refusals(estimate: Estimate, what: str) -> list[tuple[int, ...]]:
    return [decision.scans for decision in estimate.decisions if decision.what == what and not decision.accepted]


def loops(estimate: Estimate) -> list[tuple[int, ...]]:
    return [decision.scans for decision in estimate.decisions if decision.what == "loop" and decision.accepted]


def test_every_scan_gets_a_pose_and_the_first_is_the_origin(estimate: Estimate, scans: list[Scan]) -> None:
    assert estimate.poses.shape == (len(scans), 3)
    assert estimate.covariances.shape == (len(scans), 3, 3)
    np.testing.assert_allclose(estimate.poses[0], 0, atol=1e-4)


def test_a_drive_round_a_building_is_right_to_three_centimetres(estimate: Estimate, scans: list[Scan]) -> None:
    """Its wheels alone are a metre or more off in the end."""
    reckoned = np.linalg.norm(np.array([scan.odometry for scan in scans])[:, :2] - TRUE[:, :2], axis=1)
    assert np.max(reckoned) > 0.5
    assert np.max(off(estimate)) < 0.03
    assert np.max(np.abs(errors(estimate)[:, 2])) < np.radians(0.5)


def test_the_loop_is_closed_between_scans_that_stood_at_one_place(estimate: Estimate, scans: list[Scan]) -> None:
    closed = loops(estimate)
    assert len(closed) > 3
    assert any(old < 15 and new > len(scans) - 15 for old, new in closed)
    assert all(np.hypot(*between(TRUE[old], TRUE[new])[:2]) < 4 for old, new in closed)


def test_errors_are_within_the_stated_covariance(estimate: Estimate) -> None:
    """Poses of one run share their errors, so the sum is no χ² of so many; its mean must not exceed one of few."""
    squares = [
        error @ np.linalg.solve(covariance, error)
        for error, covariance in zip(errors(estimate)[1:], estimate.covariances[1:], strict=True)
    ]
    assert np.mean(squares) < chi2.ppf(0.99, 3)


def test_the_graph_is_told_of_each_way_as_surely_as_registration_knows_it(estimate: Estimate) -> None:
    """Keyframe to keyframe, registration and the wheels apart: neither repeats the other, neither boasts or is shy."""
    sums: dict[tuple[int, int], list[float]] = {}
    for tie in estimate.ties:
        if tie.moving == tie.fixed + 1:
            true = between(*(TRUE[estimate.keyframes[k]] for k in (tie.fixed, tie.moving)))
            error = between(true, tie.pose)
            sums.setdefault((tie.fixed, tie.moving), []).append(float(error @ tie.information @ error) / 3)
    registered = np.array([squares[0] for squares in sums.values()])
    assert all(len(squares) == 2 for squares in sums.values())
    assert 0.5 < np.mean(registered) < 1.7


def test_no_proven_landmark_is_doubled(estimate: Estimate) -> None:
    """Corners of the building are at least 30 cm apart."""
    gaps = np.linalg.norm(estimate.landmarks[:, None] - estimate.landmarks[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    assert len(estimate.landmarks) >= 10
    assert np.mean(gaps.min(axis=1) > 0.1) > 0.9
    assert np.all(estimate.sightings >= SETTINGS.poses.landmarks.proven)


def test_the_same_scans_give_the_same_bytes(estimate: Estimate, scans: list[Scan]) -> None:
    again = mapped(scans)
    for name in ("poses", "covariances", "landmarks", "sightings", "keyframes"):
        assert getattr(again, name).tobytes() == getattr(estimate, name).tobytes(), name
    assert again.decisions == estimate.decisions
    assert again.calibration == estimate.calibration


def test_poses_are_given_at_once_and_are_good_before_the_end(scans: list[Scan]) -> None:
    mapper = Mapper(SETTINGS.frontend, SETTINGS.poses)
    at_once = np.array([mapper.add(scan) for scan in scans[:40]])
    assert np.max(np.linalg.norm(at_once[:, :2] - TRUE[:40, :2], axis=1)) < 0.05


def test_asking_for_a_result_in_between_changes_nothing_of_what_follows(scans: list[Scan], estimate: Estimate) -> None:
    mapper = Mapper(SETTINGS.frontend, SETTINGS.poses)
    for number, scan in enumerate(scans):
        mapper.add(scan)
        if number in {0, 1, 20, 45, 100}:
            assert len(mapper.result().poses) == number + 1
    assert mapper.result().poses.tobytes() == estimate.poses.tobytes()


def test_wheels_that_claim_a_tenth_too_much_are_found_out(scans: list[Scan]) -> None:
    scaled = mapped([replace(scan, odometry=scan.odometry * [1.1, 1.1, 1.0]) for scan in scans])
    assert np.max(off(scaled)) < 0.03
    assert scaled.calibration["metres per metre"] == pytest.approx(1 / 1.1, abs=0.02)


def test_wheels_that_slip_are_reported_and_do_no_harm() -> None:
    slippery = mapped(drive(round_building(), once_round(), 3, WheelNoise(slip=0.05, slipped=1.0)))
    assert np.max(off(slippery)) < 0.04
    assert len(refusals(slippery, "odometry")) >= 2


def test_a_quarter_of_the_beams_may_be_missing(scans: list[Scan]) -> None:
    rng = np.random.default_rng(0)
    holed = [replace(scan, ranges=np.where(rng.random(scan.ranges.size) < 0.25, np.nan, scan.ranges)) for scan in scans]
    assert np.max(off(mapped(holed))) < 0.05


def test_wheels_that_never_turn_are_found_out(scans: list[Scan]) -> None:
    stuck = mapped([replace(scan, odometry=np.zeros(3)) for scan in scans[:50]])
    assert np.max(np.linalg.norm(stuck.poses[:, :2] - TRUE[:50, :2], axis=1)) < 0.1


@dataclass(frozen=True)
class Spoilt:
    """A scan that is not of this place, and the words its refusal must hold."""

    ranges: Callable[[np.random.Generator], Floats]
    says: str


ELSEWHERE = Spoilt(
    lambda rng: lidar_scan(furnished_room(np.random.default_rng(5)), np.array([2.5, 2.5, 1.0]), LIDAR, rng),
    "surface points lie on the map",
)
NOISE = Spoilt(lambda rng: rng.uniform(0.1, 11, 360), "surface points")
BLIND = Spoilt(lambda _: np.full(360, np.inf), "0 surface points")


@pytest.mark.parametrize(
    ("spoilt", "at"),
    [
        (ELSEWHERE, 60),
        (NOISE, 60),
        (BLIND, 60),
        (ELSEWHERE, 108),
        (BLIND, 108),
    ],
)
def test_a_spoilt_scan_is_refused_with_a_reason_and_the_rest_stays_right(
    scans: list[Scan], spoilt: Spoilt, at: int
) -> None:
    ranges = spoilt.ranges(np.random.default_rng(at))
    result = mapped([*scans[:at], replace(scans[at], ranges=ranges), *scans[at + 1 :]])
    refused = [decision for decision in result.decisions if decision.scans == (at,) and decision.what != "landmark"]
    reasons = [decision.reason for decision in refused if not decision.accepted]
    assert len(reasons) == 1
    assert spoilt.says in reasons[0]
    assert all(at not in closed for closed in loops(result))
    assert np.max(np.delete(off(result), at)) < 0.04


def test_no_scans_give_an_empty_estimate() -> None:
    assert mapped([]).poses.shape == (0, 3)


def test_one_scan_is_the_origin(scans: list[Scan]) -> None:
    np.testing.assert_array_equal(mapped(scans[:1]).poses, np.zeros((1, 3)))


def test_scans_of_a_robot_that_stands_share_one_keyframe() -> None:
    pose = once_round()[:1]
    standing = mapped(drive(round_building(), np.repeat(pose, 8, axis=0), seed=2))
    assert len(standing.keyframes) == 1
    assert np.max(np.abs(standing.poses[:, :2])) < 0.02


def test_no_loop_is_closed_on_a_scan_that_saw_nothing() -> None:
    scans = drive(round_building(), once_round(beyond=6.0), seed=1)
    blind = replace(scans[0], ranges=np.full(scans[0].ranges.size, np.inf))
    closed = loops(mapped([blind, *scans[1:]]))
    assert len(closed) >= 3
    assert all(0 not in pair for pair in closed)
