"""Claims about views and placing them."""

from dataclasses import replace

import numpy as np
import pytest

from backend.view import EdgeKind, View, ViewError, WideBeam, place

SQUARE = np.array([[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])


def square_view(edges: int = 4, spreads: int = 4) -> View:
    kinds = np.full(edges, EdgeKind.REAL, dtype=np.uint8)
    return View(SQUARE, kinds, np.full(spreads, 0.02), np.zeros(2), np.empty((0, 2, 2)))


def test_a_view_encloses_its_free_space() -> None:
    assert square_view().free_space.area == pytest.approx(4)


def test_arrays_that_do_not_fit_are_refused_with_numbers() -> None:
    with pytest.raises(ViewError, match="4 corners, but 3 edges"):
        square_view(edges=3)
    with pytest.raises(ViewError, match="4 corners, but 4 edges and 5 spreads"):
        square_view(spreads=5)


def test_placing_turns_first_and_then_shifts() -> None:
    placed = place(np.array([[1.0, 0.0]]), np.array([2.0, 3.0, np.pi / 2]))
    np.testing.assert_allclose(placed, [[2.0, 4.0]], atol=1e-12)


def test_what_is_surely_free_ends_on_the_beams_of_the_boundary() -> None:
    wide = WideBeam(np.array([1.0, np.inf, np.inf, 0.5]), np.zeros(4))
    ring = replace(square_view(), wide=wide).surely_free
    np.testing.assert_allclose(ring[1:3], SQUARE[1:3])
    np.testing.assert_allclose(np.linalg.norm(ring[[0, 3]], axis=1), [1.0, 0.5])
    np.testing.assert_allclose(ring[:, 0] * SQUARE[:, 1], ring[:, 1] * SQUARE[:, 0], atol=1e-12)


def test_views_say_the_same_when_all_their_arrays_do() -> None:
    wide = WideBeam(np.full(4, 0.5), np.zeros(4))
    assert square_view().says_the_same(square_view())
    assert not square_view().says_the_same(replace(square_view(), boundary=1.01 * SQUARE))
    assert not square_view().says_the_same(replace(square_view(), wide=wide))
    assert replace(square_view(), wide=wide).says_the_same(replace(square_view(), wide=wide))
