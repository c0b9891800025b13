"""Registration in rooms of known truth: it recovers motions, says how sure it is, and says when it cannot know."""

import numpy as np
import pytest
from scipy.stats import chi2
from shapely import box

from frontend.local_map import Faces, LocalMap
from frontend.registration import Alignment, Guess, RegistrationSettings, register, register_submaps
from frontend.rigid_motion import between, compose, inverse, wrap
from frontend.scan import Floats
from frontend.surface import Surface
from tests.simulated_drives import corridor, faces_from, furnished_room, surface_at, world_of

UNKNOWN = np.zeros((3, 3))
SETTINGS = RegistrationSettings()


def laid_on(surface: Surface, faces: Faces, guess: Floats, information: Floats = UNKNOWN) -> Alignment:
    return register(surface, LocalMap.of(faces), Guess(np.asarray(guess, float), information), SETTINGS)


def one_draw(seed: int, views: int) -> tuple[Alignment, Floats]:
    """A scan laid on a map of some views of a random room, from 8 cm and 4° off; the alignment and its error (3,)."""
    rng = np.random.default_rng(seed)
    world = furnished_room(rng)
    centre = np.array(world.free.centroid.coords[0])
    poses = [np.array([*(centre + rng.uniform(-0.6, 0.6, 2)), rng.uniform(-3, 3)]) for _ in range(views + 1)]
    aside = rng.uniform(-np.pi, np.pi)
    start = poses[0] + [0.08 * np.cos(aside), 0.08 * np.sin(aside), np.radians(4) * rng.choice([-1, 1])]
    found = laid_on(surface_at(world, poses[0], rng), faces_from(world, poses[1:], rng), start)
    error = found.pose_in_fixed - poses[0]
    error[2] = float(wrap(error[2]))
    return found, error


@pytest.fixture(scope="module")
def draws() -> dict[int, list[tuple[Alignment, Floats]]]:
    return {views: [one_draw(seed, views) for seed in range(60)] for views in (1, 6)}


@pytest.mark.parametrize("views", [1, 6])
def test_a_known_motion_is_recovered_from_8_cm_and_4_degrees_off(
    draws: dict[int, list[tuple[Alignment, Floats]]], views: int
) -> None:
    """A range noise of 1.5 cm over some 350 readings leaves millimetres; every draw counts, none may fail."""
    errors = np.array([error for _, error in draws[views]])
    metres, radians = np.hypot(errors[:, 0], errors[:, 1]), np.abs(errors[:, 2])
    assert np.max(metres) < 0.015
    assert np.median(metres) < 0.004
    assert np.max(radians) < np.radians(0.3)
    assert min(found.matched for found, _ in draws[views]) > 0.7


@pytest.mark.parametrize("views", [1, 6])
def test_the_covariance_is_honest(draws: dict[int, list[tuple[Alignment, Floats]]], views: int) -> None:
    """Mean squared error in units of the stated covariance: the sum over draws is χ² if the covariance is right.

    A map of one view is noisy itself and its noise is the same for all that lies on it, so it may say a bit less.
    """
    squares = [error @ found.information @ error for found, error in draws[views]]
    assert 0.6 < np.mean(squares) / 3 < 1.6
    assert np.mean(np.array(squares) > chi2.ppf(0.999, 3)) < 0.1


def test_the_stated_residual_is_the_noise_of_the_sensor(draws: dict[int, list[tuple[Alignment, Floats]]]) -> None:
    residuals = [found.residual for found, _ in draws[6]]
    assert 0.005 < np.median(residuals) < 0.02


def test_the_answer_does_not_depend_on_the_frame_it_is_asked_in() -> None:
    rng = np.random.default_rng(3)
    world, pose = furnished_room(rng), np.array([2.6, 2.4, 0.4])
    faces, surface = faces_from(world, [np.array([2.3, 2.6, 0])], rng), surface_at(world, pose, rng)
    start, frame = pose + np.array([0.05, -0.04, 0.03]), np.array([7.0, -3.0, 2.0])
    here = laid_on(surface, faces, start)
    there = laid_on(surface, faces.moved(frame), compose(frame, start))
    np.testing.assert_allclose(between(compose(frame, here.pose_in_fixed), there.pose_in_fixed), np.zeros(3), atol=1e-3)
    assert there.firmness == pytest.approx(here.firmness, rel=0.05)


def test_a_corridor_is_reported_as_free_to_slide_and_a_room_is_not() -> None:
    rng = np.random.default_rng(0)
    true, guess = np.array([30.2, 1.0, 0.0]), np.array([30.0, 1.04, 0.02])
    faces = faces_from(corridor(), [np.array([30.0, 1.0, 0.0])], rng)
    found = laid_on(surface_at(corridor(), true, rng), faces, guess)
    assert found.firmness < 0.01
    assert abs(found.pose_in_fixed[1] - 1.0) < 0.01
    assert abs(found.pose_in_fixed[2]) < 0.005
    along, across = found.information[0, 0], found.information[1, 1]
    assert along < 0.01 * across
    assert one_draw(0, 1)[0].firmness > 0.2


def test_along_a_corridor_the_odometry_decides_and_across_it_the_walls() -> None:
    rng = np.random.default_rng(1)
    true, guess = np.array([30.2, 1.0, 0.0]), np.array([30.19, 1.06, 0.02])
    faces = faces_from(corridor(), [np.array([30.0, 1.0, 0.0])], rng)
    prior = np.diag(np.array([0.02, 0.05, 0.03]) ** -2.0)
    found = laid_on(surface_at(corridor(), true, rng), faces, guess, prior)
    assert abs(found.pose_in_fixed[0] - 30.19) < 0.03
    assert abs(found.pose_in_fixed[1] - 1.0) < 0.01


@pytest.mark.parametrize("shift", [0.1, -0.1])
def test_a_thin_wall_seen_from_both_sides_does_not_collapse(shift: float) -> None:
    """The map knows the south of a wall of 10 cm; a scan from the north starts where its face would lie on that."""
    rng = np.random.default_rng(2)
    world = world_of(box(0, 0, 8, 6.1), box(3.2, 3, 4.8, 3.1))
    faces = faces_from(world, [np.array([4, 1.5, 0])], rng)
    true = np.array([4, 4.6, 0.0])
    found = laid_on(surface_at(world, true, rng), faces, true + np.array([0, shift, 0]))
    assert np.hypot(*(found.pose_in_fixed - true)[:2]) < 0.02


def test_matched_faces_look_the_same_way() -> None:
    rng = np.random.default_rng(4)
    world = world_of(box(0, 0, 8, 6.1), box(3.2, 3, 4.8, 3.1))
    poses = [np.array([4, 1.5, 0]), np.array([4, 4.6, 0])]
    local_map, surface = LocalMap.of(faces_from(world, poses, rng)), surface_at(world, np.array([1.0, 4.0, 0.5]), rng)
    found = register(surface, local_map, Guess(np.array([1.0, 4.0, 0.5]), UNKNOWN), SETTINGS)
    own = Faces.placed(surface, found.pose_in_fixed).normals[found.pairs[:, 0]]
    assert len(found.pairs) > 0.5 * len(surface.points)
    assert np.min(np.sum(own * local_map.faces.normals[found.pairs[:, 1]], axis=1)) >= SETTINGS.alike - 1e-9


def test_pairs_and_the_matched_share_say_the_same() -> None:
    found, _ = one_draw(5, 1)
    assert len(np.unique(found.pairs[:, 0])) == len(found.pairs)
    surface_points = len(found.pairs) / found.matched
    assert surface_points == pytest.approx(round(surface_points))


def test_a_scan_of_another_place_matches_nothing_and_claims_to_know_nothing() -> None:
    rng = np.random.default_rng(6)
    world = furnished_room(rng)
    pose = np.array([2.5, 2.5, 0.0])
    found = laid_on(surface_at(world, pose, rng), faces_from(world, [pose], rng), pose + np.array([60, 0, 0]))
    assert found.matched == 0
    assert len(found.pairs) == 0
    np.testing.assert_array_equal(found.information, 0)
    assert found.firmness == 0


def test_a_fifth_of_moved_furniture_does_not_pull_the_pose() -> None:
    rng = np.random.default_rng(8)
    still, moved = (world_of(box(0, 0, 6, 5), box(2, 0, 3, y), box(x, 4.2, x + 1, 5)) for x, y in ((1, 0.5), (3, 0.9)))
    true = np.array([3.0, 2.5, 0.3])
    found = laid_on(surface_at(moved, true, rng), faces_from(still, [true], rng), true + np.array([0.05, 0.05, 0.05]))
    assert np.hypot(*(found.pose_in_fixed - true)[:2]) < 0.01
    assert found.matched < 0.98


def test_whole_submaps_are_laid_on_each_other() -> None:
    rng = np.random.default_rng(9)
    world = furnished_room(rng)
    centre = np.array([2.5, 2.5, 0.0])
    fixed = faces_from(world, [centre, centre + np.array([0.3, 0.2, 1.0])], rng)
    frame = np.array([2.2, 2.9, 0.7])
    moving = faces_from(world, [centre + np.array([-0.2, 0.1, 2.0]), centre + np.array([0.1, -0.2, -1.0])], rng).moved(
        inverse(frame)
    )
    found = register_submaps(moving, fixed, compose(frame, np.array([0.15, -0.1, 0.05])), 0.4)
    error = between(frame, found)
    assert np.hypot(*error[:2]) < 0.01
    assert abs(error[2]) < np.radians(0.2)


def test_a_freed_alignment_doubts_its_place_along_the_corridor_and_knows_the_rest_as_before() -> None:
    information = np.diag([4e4, 1e6, 1e6])
    found = Alignment(np.zeros(3), information, np.empty((0, 2), np.int64), 0.01, 1.0, 0.04)
    covariance = np.linalg.inv(found.freed(0.7).information)
    np.testing.assert_allclose(np.diag(covariance), [1 / 4e4 + 0.49, 1e-6, 1e-6], rtol=1e-6)


def test_submaps_are_laid_alike_time_after_time() -> None:
    rng = np.random.default_rng(0)
    world = furnished_room(rng)
    centre = np.array(world.free.centroid.coords[0])
    poses = [np.array([*(centre + rng.uniform(-0.6, 0.6, 2)), rng.uniform(-3, 3)]) for _ in range(8)]
    fixed, moving = faces_from(world, poses[:4], rng), faces_from(world, poses[4:], rng).moved(inverse(poses[4]))
    guess = poses[4] + [0.1, 0.1, 0.03]
    assert len({register_submaps(moving, fixed, guess, 0.4).tobytes() for _ in range(60)}) == 1
