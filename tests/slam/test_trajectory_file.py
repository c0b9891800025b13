"""Trajectories: poses survive writing and reading; a camera's positions are read without headings."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from slam.trajectory_file import TrajectoryFileError, read_trajectory, tum_text

poses = st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.floats(-np.pi, np.pi))


@given(st.lists(poses, min_size=1, max_size=20))
def test_poses_survive_writing_and_reading(
    tmp_path_factory: pytest.TempPathFactory, drive: list[tuple[float, float, float]]
) -> None:
    path = tmp_path_factory.mktemp("drive") / "trajectory.tum"
    times = 976052857.337 + 0.25 * np.arange(len(drive), dtype=np.float64)
    path.write_text(tum_text(times, np.array(drive)))
    read = read_trajectory(path)
    assert np.allclose(read.times, times, atol=1e-6)
    assert np.allclose(read.positions, np.array(drive)[:, :2], atol=1e-6)
    turned = read.poses[:, 2] - np.array(drive)[:, 2]
    assert np.allclose(np.exp(1j * turned), 1, atol=1e-8)


def test_a_camera_gives_positions_in_metres_and_seconds(tmp_path: Path) -> None:
    path = tmp_path / "camera.txt"
    path.write_text("P 378 1850 1897\nP 494 1853 1897\n")
    read = read_trajectory(path)
    assert np.allclose(read.times, [0.378, 0.494])
    assert np.allclose(read.positions, [[1.85, 1.897], [1.853, 1.897]])
    with pytest.raises(TrajectoryFileError, match="without headings"):
        _ = read.poses


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no pose in it"),
        ("1 0 0 0 0 0 0 1\n2 0 0\n", r"a\.tum line 2: 3 fields"),
        ("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", r"a\.tum line 2: its time does not come after"),
        ("1 0 x 0 0 0 0 1\n", r"a\.tum line 1: could not convert"),
        ("1 0 nan 0 0 0 0 1\n", "not finite"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "a.tum"
    path.write_text(text)
    with pytest.raises(TrajectoryFileError, match=says):
        read_trajectory(path)
