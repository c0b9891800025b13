"""The factor graph as g2o text: keyframes first, landmarks numbered after them, information by its upper triangle."""

import numpy as np

from backend.estimate import Estimate, LandmarkTie, Tie
from slam.pose_graph_file import g2o_text

FULL = np.array([[100.0, 1.0, 2.0], [1.0, 200.0, 3.0], [2.0, 3.0, 300.0]])


def text_of(ties: tuple[Tie, ...], seen: tuple[LandmarkTie, ...]) -> list[str]:
    """Lines for three scans, the first and the last of them keyframes, and two landmarks."""
    return g2o_text(
        Estimate(
            poses=np.array([[0.0, 0, 0], [0.5, 0, 0], [1.0, 0.25, -1.5]]),
            covariances=np.zeros((3, 3, 3)),
            landmarks=np.array([[3.5, 1.2], [4.0, -1.0]]),
            sightings=np.array([2, 2]),
            keyframes=np.array([0, 2]),
            decisions=(),
            calibration={},
            mapped=np.ones(3, np.bool_),
            ties=ties,
            landmark_ties=seen,
        )
    ).splitlines()


def test_only_keyframes_are_vertices_and_landmarks_are_numbered_after_them() -> None:
    assert text_of((), ()) == [
        "VERTEX_SE2 0 0 0 0",
        "VERTEX_SE2 1 1 0.25 -1.5",
        "VERTEX_XY 2 3.5 1.2",
        "VERTEX_XY 3 4 -1",
    ]


def test_an_edge_holds_the_upper_triangle_row_by_row() -> None:
    (edge,) = text_of((Tie(0, 1, np.array([1.0, 0.0, 0.1]), FULL),), ())[4:]
    assert edge == "EDGE_SE2 0 1 1 0 0.1 100 1 2 200 3 300"


def test_a_sighting_names_its_landmark_by_the_number_of_the_vertex() -> None:
    (edge,) = text_of((), (LandmarkTie(1, 1, np.array([2.0, 0.5]), FULL[:2, :2]),))[4:]
    assert edge == "EDGE_SE2_XY 1 3 2 0.5 100 1 200"
