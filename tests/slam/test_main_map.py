"""The main map: most scans win, the first of equals, and whatever is left out is told."""

import numpy as np
import pytest

from slam.main_map import left_out, main_root


@pytest.mark.parametrize(("roots", "main"), [([], 0), ([0, 0, 2], 0), ([0, 2, 2], 2), ([0, 0, 1, 1], 0)])
def test_the_frame_with_most_scans_is_the_map(roots: list[int], main: int) -> None:
    assert main_root(np.array(roots, np.int64)) == main


def test_every_other_frame_is_told_with_its_scans() -> None:
    told = left_out(np.array([0, 1, 1, 0, 3]), 0)
    assert [made.scans for made in told] == [(1, 2), (4,)]
    assert "none of its 2 scans" in told[0].reason


def test_nothing_is_told_of_one_frame() -> None:
    assert left_out(np.zeros(5, np.int64), 0) == []
