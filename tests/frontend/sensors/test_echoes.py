import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from frontend.sensors.echoes import Echoes, diffraction_width, echoes_around, fresnel_share
from frontend.sensors.surfaces import Material, Surfaces
from frontend.sensors.transducer import Transducer
from tests.frontend.sensors.bodies import block, body, pole, surfaces_of, wall_at

DRY = Transducer(humidity=0.0)
MIRROR = Material(roughness=0.0, albedo=0.0)


def echoes_of(surfaces: Surfaces) -> Echoes:
    return echoes_around(surfaces, np.zeros(2), DRY, np.random.default_rng(0))


def on_axis(echoes: Echoes, number: int) -> float:
    """Energy of an echo with the air's share given back."""
    return float(echoes.energies[number] * np.exp(2 * DRY.decay * echoes.lengths[number]))


def test_a_mirror_answers_once_from_the_foot_of_the_normal_like_its_image() -> None:
    echoes = echoes_of(wall_at(2.0, MIRROR))
    loudest = int(np.argmax(echoes.energies))
    assert echoes.lengths[loudest] == pytest.approx(2.0, abs=1e-4)
    assert echoes.directions[loudest] == pytest.approx(0.0, abs=1e-4)
    assert on_axis(echoes, loudest) == pytest.approx(1 / 4.0**2, rel=2e-3)
    # What is left are the edges of the wall, 40 m away.
    assert np.delete(echoes.lengths, loudest).min() > 40


def test_a_rough_wall_answers_from_everywhere_with_lamberts_energy() -> None:
    rough = Material(roughness=1.0, albedo=0.3)
    seeds = [echoes_around(wall_at(2.0, rough), np.zeros(2), DRY, np.random.default_rng(k)) for k in range(30)]
    ahead = [e.energies[np.abs(e.directions) < 0.1] * np.exp(2 * DRY.decay * 2.0) for e in seeds]
    assert np.sum(ahead, axis=1).mean() == pytest.approx(0.3 / np.pi / 4 * 0.2, rel=0.06)
    assert np.all(seeds[0].tall)


def test_a_square_corner_of_mirrors_answers_over_twice_the_way_to_its_vertex() -> None:
    corner = body([(2, -30), (2, 2), (-30, 2), (-30, 2.2), (2.2, 2.2), (2.2, -30)], MIRROR)
    echoes = echoes_of(surfaces_of(corner))
    vertex = np.argmin(np.abs(echoes.directions - np.pi / 4))
    assert echoes.lengths[vertex] == pytest.approx(np.sqrt(8), abs=0.01)
    assert on_axis(echoes, int(vertex)) == pytest.approx(1 / 32, rel=0.02)


def test_a_corner_that_is_not_square_sends_nothing_back() -> None:
    corner = body([(2, -30), (2, 2), (-20, 24), (-20, 25), (3, 2), (3, -30)], MIRROR)
    directions = echoes_of(surfaces_of(corner)).directions
    assert np.min(np.abs(directions - np.pi / 4)) > 0.1


def test_an_oblique_mirror_shows_the_wall_behind_at_the_length_of_the_folded_path() -> None:
    mirror = body([(2, -1), (4, 1), (4.2, 1), (2.2, -1)], MIRROR)  # turns a ray ahead upwards at x = 3
    echoes = echoes_of(surfaces_of(mirror, block(-9, 5, 9, 6, MIRROR)))
    folded = np.abs(echoes.directions) < 0.01
    assert echoes.lengths[folded] == pytest.approx([8.0], abs=0.01)
    assert on_axis(echoes, int(np.flatnonzero(folded)[0])) == pytest.approx(1 / 16**2, rel=0.03)


def test_a_thin_pole_answers_by_its_radius() -> None:
    echoes = echoes_of(surfaces_of(pole(1.0, 0.05)))
    foot = int(np.argmax(echoes.energies * ~echoes.tall))
    assert echoes.lengths[foot] == pytest.approx(1.0, abs=2e-3)
    assert on_axis(echoes, foot) == pytest.approx(1 / 4 * 0.05 / 1.05, rel=0.03)


def test_slats_answer_only_by_way_of_the_floor() -> None:
    echoes = echoes_of(wall_at(0.5, "slatted", half=0.6))
    tilt = np.radians(25)
    assert echoes.lengths.min() == pytest.approx(0.5 + DRY.height / np.sin(2 * tilt), rel=1e-3)


def test_echoes_are_the_same_for_the_same_seed() -> None:
    first, second = echoes_of(wall_at(2.0, "rough")), echoes_of(wall_at(2.0, "rough"))
    assert np.array_equal(first.energies, second.energies)


def test_half_a_mirror_leaves_a_quarter_and_an_endless_one_all() -> None:
    shares = fresnel_share(np.array([0.0, 50.0, 0.001]), np.array([50.0, 50.0, 0.001]), np.array([0.01, 0.01, 0.01]))
    assert shares[:2] == pytest.approx([0.25, 1.0], abs=0.01)
    assert shares[2] == pytest.approx((0.002 * 2) ** 2 / 0.01 / 2, rel=0.01)


@settings(deadline=None, max_examples=30)
@given(st.floats(1.1, 2.0), st.floats(0.05, 0.95))
def test_a_wedge_looks_the_same_from_both_of_its_faces(wedge: float, share: float) -> None:
    angle = share * wedge * np.pi
    ends = [
        float(diffraction_width(np.array([wedge]), np.array([side]), 0.0065)[0])
        for side in (angle, wedge * np.pi - angle)
    ]
    assume(max(ends) < 1e3)  # towards a face's own mirror image the theory has no bound
    assert ends[0] == pytest.approx(ends[1], rel=1e-6)


def test_a_wedge_that_is_no_wedge_does_not_diffract() -> None:
    assert diffraction_width(np.array([1.0001]), np.array([1.0]), 0.0065)[0] < 1e-8
