import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, Point

from frontend.sensors.rays import cast, incidence_cosines, trace
from frontend.sensors.surfaces import Surfaces
from tests.frontend.sensors.bodies import block, pole, surfaces_of

CLUTTER = surfaces_of(
    block(2, -1, 3, 1), block(-3, 1.5, -2, 3), pole(1.0, 0.2), block(-6, -6, -5, 6), block(-4, -5, 4, -4)
)


def nearest_by_shapely(surfaces: Surfaces, origin: Point, angle: float) -> float:
    """Distance along a ray to any segment, the slow way."""
    ray = LineString([(origin.x, origin.y), (origin.x + 50 * np.cos(angle), origin.y + 50 * np.sin(angle))])
    met = np.asarray(shapely.intersection(ray, shapely.linestrings(surfaces.segments)))
    return float(np.nanmin(np.append(shapely.distance(origin, met), np.inf)))


@settings(deadline=None, max_examples=60)
@given(st.floats(-0.9, 0.9), st.floats(-3.5, 1.0), st.floats(-np.pi, np.pi))
def test_a_ray_meets_what_the_geometry_library_says_it_meets(x: float, y: float, angle: float) -> None:
    distances, _ = cast(CLUTTER, np.array([x, y]), np.array([angle]))
    expected = nearest_by_shapely(CLUTTER, Point(x, y), angle)
    assert distances[0] == pytest.approx(expected, abs=1e-6)


def test_a_ray_into_the_open_meets_nothing() -> None:
    distances, hits = cast(surfaces_of(block(1, -1, 2, 1)), np.zeros(2), np.array([np.pi]))
    assert np.isinf(distances[0])
    assert hits[0] == -1


def test_incidence_is_measured_from_the_normal() -> None:
    surfaces = surfaces_of(block(1, -9, 2, 9))
    angles = np.radians([0.0, 30.0, -60.0])
    _, hits = cast(surfaces, np.zeros(2), angles)
    assert incidence_cosines(surfaces, angles, hits) == pytest.approx(np.cos(angles))


@settings(deadline=None, max_examples=40)
@given(st.floats(0.05, 1.2))
def test_a_mirrored_ray_travels_as_far_as_the_straight_one_in_the_mirrored_world(angle: float) -> None:
    mirror, target = block(1, -20, 1.2, 20), block(-3, -20, -2, 20)
    paths = trace(surfaces_of(mirror, target), np.zeros(2), np.array([angle]), np.ones(8, bool), 1)
    # The wall at x = −2 seen in the mirror at x = 1 stands at x = 4.
    assert paths.lengths[0] == pytest.approx([1 / np.cos(angle), 4 / np.cos(angle)])
    assert np.abs(paths.sines[0]) == pytest.approx(np.sin(angle))


def test_a_ray_is_not_followed_past_a_wall_that_is_no_mirror() -> None:
    surfaces = surfaces_of(block(1, -20, 1.2, 20), block(-3, -20, -2, 20))
    paths = trace(surfaces, np.zeros(2), np.array([0.3]), np.zeros(8, bool), 2)
    assert np.isfinite(paths.lengths[0]).tolist() == [True, False, False]
    assert paths.hits[0].tolist() == [0, -1, -1]


def test_where_a_wall_was_met_is_measured_from_its_start() -> None:
    paths = trace(surfaces_of(block(1, -2, 2, 5)), np.zeros(2), np.array([0.0]), np.zeros(4, bool), 0)
    assert paths.offsets[0, 0] == pytest.approx(2.0)
