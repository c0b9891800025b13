"""Walls and edges are born of arcs that agree."""

from dataclasses import replace

import numpy as np

from backend.arc_births import BirthSettings, Loose, births
from backend.arcs import Floats

PLACES = np.array([[0.0, 0.0], [0.8, 0.1], [1.5, -0.2], [2.2, 0.4]])


def loose_of(ranges: Floats, headings: Floats, *, rising: bool) -> Loose:
    n = len(ranges)
    return Loose(
        np.arange(n), np.resize(PLACES, (n, 2)), ranges, 0.01, headings, np.full(n, 0.05),
        np.full(n, -0.6), np.full(n, 0.6), headings, np.full(n, 0.05), np.full(n, rising),
    )  # fmt: skip


def test_circles_that_touch_one_line_are_a_wall() -> None:
    (born,) = births(loose_of(2.0 - PLACES[:, 1], np.full(4, np.pi / 2), rising=True), 3, 0.01, BirthSettings())
    assert born.wall
    assert np.allclose(born.values, [np.pi / 2, 2.0], atol=0.03)
    assert list(born.members) == [0, 1, 2, 3]


def test_circles_that_cross_in_one_place_are_an_edge() -> None:
    rays = np.array([1.0, 1.5]) - PLACES
    (born,) = births(
        loose_of(np.hypot(*rays.T), np.arctan2(rays[:, 1], rays[:, 0]), rising=True), 3, 0.01, BirthSettings()
    )
    assert not born.wall
    assert np.allclose(born.values, [1.0, 1.5], atol=0.03)


def test_two_views_are_too_few() -> None:
    loose = loose_of(2.0 - PLACES[:2, 1], np.full(2, np.pi / 2), rising=True)
    assert not list(births(loose, 1, 0.01, BirthSettings()))


def test_the_two_corners_of_a_walls_end_are_not_one_edge() -> None:
    places = np.array([[-1.2, 0.0], [-0.8, 0.0], [-0.4, 0.0], [0.5, 0.0], [0.9, 0.0], [1.3, 0.0]])
    rays = np.where(places[:, :1] < 0, [0.0, 0.5], [0.1, 0.5]) - places
    headings = np.arctan2(rays[:, 1], rays[:, 0])
    seen = loose_of(np.hypot(*rays.T), headings, rising=False)
    loose = replace(seen, owner=np.arange(6), places=places)
    (born,) = births(loose, 5, 0.01, BirthSettings())
    assert list(born.members) == [3, 4, 5]
    assert np.allclose(born.values, [0.1, 0.5], atol=0.01)
