import numpy as np
import pytest

from frontend.sensors.surfaces import MATERIALS, SurfaceError, Surfaces, coherent_share
from tests.frontend.sensors.bodies import block, surfaces_of

WAVELENGTH = 0.0065


def test_plasterboard_is_a_mirror_and_cinder_block_is_not() -> None:
    smooth, rough = (np.array(MATERIALS[name].roughness) for name in ("smooth", "rough"))
    square_on = np.array(1.0)
    assert coherent_share(smooth, square_on, WAVELENGTH) > 0.98
    assert coherent_share(rough, square_on, WAVELENGTH) < 1e-9


def test_every_wall_turns_into_a_mirror_as_the_sound_grazes_it() -> None:
    rough = np.full(50, MATERIALS["rough"].roughness)
    shares = coherent_share(rough, np.linspace(1, 0, 50), WAVELENGTH)
    assert np.all(np.diff(shares) >= 0)
    assert shares[-1] == 1


def test_the_four_corners_of_a_box_are_convex_right_angles_seen_from_outside() -> None:
    assert surfaces_of(block(0, 0, 1, 1)).corner_turns() == pytest.approx(-np.pi / 2)


def test_segments_follow_each_other_within_their_ring_only() -> None:
    surfaces = surfaces_of(block(0, 0, 1, 1), block(2, 0, 3, 1))
    assert list(surfaces.following) == [1, 2, 3, 0, 5, 6, 7, 4]
    assert surfaces.segments[:, 1] == pytest.approx(surfaces.segments[surfaces.following, 0])


def test_columns_that_do_not_fit_the_segments_are_refused_by_name() -> None:
    good = surfaces_of(block(0, 0, 1, 1))
    columns = {name: getattr(good, name) for name in good.__dataclass_fields__}
    with pytest.raises(SurfaceError, match=r"4 segments, but tilt has shape \(3,\)"):
        Surfaces(**columns | {"tilt": np.zeros(3)})
