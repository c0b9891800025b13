import numpy as np
import pytest

from planners.spine_graph import crossings


def test_spines_cross_where_their_lines_do() -> None:
    met = crossings(np.array([[0.0, 0, 4, 0], [1, -1, 1, 3], [5, -1, 5, 1]]))
    assert met.shape == (1, 4)
    assert met[0] == pytest.approx([0, 1, 0.25, 0.25])


@pytest.mark.parametrize("tilt", [0.0, 1e-16, -1e-13, 1e-9])
def test_spines_on_one_line_never_cross_whatever_rounding_says(tilt: float) -> None:
    along = np.array([np.cos(0.7), np.sin(0.7)])
    bent = np.array([np.cos(0.7 + tilt), np.sin(0.7 + tilt)])
    spines = np.stack([np.concatenate([0 * along, 5 * along]), np.concatenate([7 * along, 7 * along + 5 * bent])])
    assert len(crossings(spines)) == 0
