"""Claims about what it takes to say that a view saw through a piece of face."""

import numpy as np
from numpy.typing import NDArray

from backend.leak_repair import FaceBins
from backend.seen_through import beams_of, met, seen_through
from backend.sight import sight_of

ORIGIN = np.array([[0.0, 2.0]])
BOX = np.array([[-9.0, -1.0], [9.0, -1.0], [9.0, 4.0], [-9.0, 4.0]])


def bins_at(*along: float) -> FaceBins:
    """Bins of 10 cm on the line y = 0 that face upward, so many metres along."""
    middles = np.array([[x, 0.0] for x in along])
    count = len(along)
    return FaceBins(middles, np.tile([0.0, 1.0], (count, 1)), np.full(count, 0.1), np.full(count, 2))


def counted(bins: FaceBins, *readings: tuple[float, float]) -> list[int]:
    """By how many views each bin was seen through, of one that holds BOX for free and read these points."""
    placed: NDArray[np.float64] = np.array(readings).reshape(-1, 2)
    return list(seen_through(bins, beams_of(sight_of([BOX], ORIGIN), [placed]), 0.05))


def test_a_pillar_between_two_beams_is_not_seen_through() -> None:
    assert counted(bins_at(1.0), (0.0, -1.0), (6.0, -1.0)) == [0]


def test_a_beam_through_a_piece_says_so() -> None:
    assert counted(bins_at(1.0), (0.0, -1.0), (1.5, -1.0), (6.0, -1.0)) == [1]


def test_a_reading_on_the_piece_did_not_pass() -> None:
    assert counted(bins_at(1.0), (0.0, -1.0), (1.0, -0.02), (6.0, -1.0)) == [0]


def test_two_beams_through_one_wall_speak_for_what_lies_between() -> None:
    wall = bins_at(0.0, 1.0, 2.0)
    assert counted(wall, (0.0, -1.0), (3.0, -1.0), (9.0, 3.0)) == [1, 1, 1]
    assert counted(wall.where(np.array([True, True, False])), (0.0, -1.0), (3.0, -1.0), (9.0, 3.0)) == [1, 0]


def test_bearings_meet_behind_the_back_of_a_view() -> None:
    turned = np.array([[-1.0, 2.0]])
    middles, normals = np.array([[-5.0, 2.0]]), np.array([[1.0, 0.0]])
    bins = FaceBins(middles, normals, np.full(1, 0.1), np.full(1, 2))
    for readings in ([[-8.0, 2.05], [8.0, 2.0]], [[-8.0, 1.95], [8.0, 2.0]]):
        beams = beams_of(sight_of([BOX], turned), [np.array(readings)])
        assert seen_through(bins, beams, 0.05).tolist() == [1]


def test_a_wide_beam_is_taken_at_its_word() -> None:
    assert counted(bins_at(1.0)) == [1]


def test_only_readings_on_a_piece_support_it() -> None:
    sight = sight_of([BOX, BOX], np.repeat(ORIGIN, 2, axis=0))
    bins, near = bins_at(1.0, 2.0, 3.0), np.array([[1.02, 0.01], [3.0, 0.0]])
    assert met(bins, beams_of(sight, [near, near[:1]])).support.tolist() == [2, 0, 1]
    assert met(bins, beams_of(sight, [near, near[:0]])).support.tolist() == [2, 2, 2]
