"""A wall as a wide beam reads it."""

import numpy as np

from frontend.arc_fit import fit_wall, level, wall_ranges

BEAM = np.array([[0.5, 0.5], [2.0, 0.2], [5.0, 0.1]])


def test_a_wall_reads_level_within_the_half_beam_and_rises_beside_it() -> None:
    half = float(np.interp(1.0, BEAM[:, 0], BEAM[:, 1]))
    read = wall_ranges(np.array([0.0, half * 0.9, half + 0.2, -half - 0.2, 1.5]), np.array([1.0, 0.0, 1.0]), BEAM)
    assert np.allclose(read[:2], 1.0)
    assert read[2] == read[3] > 1.01
    assert np.isinf(read[4])


def test_a_fit_recovers_the_wall_it_was_made_of() -> None:
    bearings = np.linspace(-np.pi, np.pi, 256, endpoint=False)
    true = np.array([1.2, 0.4, 1.1])
    ranges = wall_ranges(bearings - 0.4, true, BEAM)
    start, noise = np.array([1.215, 0.45, 1.0]), np.array([0.01, 0.04, 3.0, 2.0])
    around = int(np.argmin(np.abs(bearings - 0.45)))
    wall, information, held = fit_wall(bearings, ranges, start, BEAM, noise, np.array([1.0, 0.5]), around, True)
    assert np.allclose(wall[:2], true[:2], atol=0.01)
    assert held.sum() > 20
    assert np.all(np.linalg.eigvalsh(information) > 0)


def test_a_region_ends_where_it_ends_and_says_which_side_opens() -> None:
    ranges = np.array([3.0] * 5 + [1.0] * 7 + [0.4] * 5)
    assert level(ranges, 1.0, 0.03, 8, True) == (3, 3, True, False)
