"""The factor graph as g2o text: keyframes, landmarks, and what was measured between them.

gtsam's own writer leaves landmarks and their sightings out, so the lines are written here.
"""

import numpy as np

from backend.estimate import Estimate, Floats


def g2o_text(estimate: Estimate) -> str:
    """VERTEX_SE2 and VERTEX_XY at the final estimate, EDGE_SE2 and EDGE_SE2_XY with their information matrices."""
    poses = estimate.poses[estimate.keyframes]
    first = len(poses)  # landmarks are numbered after the poses
    lines = [f"VERTEX_SE2 {number} {_row(pose)}" for number, pose in enumerate(poses)]
    lines += [f"VERTEX_XY {first + number} {_row(place)}" for number, place in enumerate(estimate.landmarks)]
    lines += [
        f"EDGE_SE2 {tie.fixed} {tie.moving} {_row(tie.pose)} {_row(_upper(tie.information))}" for tie in estimate.ties
    ]
    lines += [
        f"EDGE_SE2_XY {seen.pose} {first + seen.landmark} {_row(seen.position)} {_row(_upper(seen.information))}"
        for seen in estimate.landmark_ties
    ]
    return "\n".join(lines) + "\n"


def _upper(information: Floats) -> Floats:
    """The upper triangle, row by row, as g2o has it."""
    return information[np.triu_indices(len(information))]


def _row(numbers: Floats) -> str:
    return " ".join(f"{number:.9g}" for number in numbers)
