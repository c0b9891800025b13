"""Another system's poses of a log, run by an interpreter that has it: scans as JSON on stdin, poses as the last line.

`python pose_rivals.py NAME`; the log is `bearings` (n,), `scans` with `ranges` (n,), not finite where nothing was seen,
and `odometry` (3,) of the laser, taken as the robot's. All of them get the odometry between scans as first guess. A
system that cannot be imported answers with a sentence instead.
"""

import importlib
import json
import sys
from collections import deque
from collections.abc import Iterator
from time import process_time
from typing import Any

import numpy as np

Log = dict[str, Any]
FARTHEST = 20.0  # metres of a beam that are used, yag-slam's own default; Karto's matcher needs a limit
VOXEL = 0.25  # metres
HEIGHTS = np.array([-0.1, 0.0, 0.1])  # metres: small_gicp needs walls that stand, a flat cloud has no planes
SUBMAP = 12  # scans


def yag_slam(log: Log) -> Iterator[Any]:
    """Karto's matcher with its loops and sparse pose adjustment, all at the package's defaults."""
    graph_slam, matching, models = (
        importlib.import_module(f"yag_slam.{part}") for part in ("graph_slam", "scan_matching", "models")
    )
    loops = matching.Scan2DMatcherCpp({}, loop=True)
    slam, bearings = graph_slam.GraphSlam(matching.Scan2DMatcherCpp({}), loops), log["bearings"]
    step = (bearings[-1] - bearings[0]) / (len(bearings) - 1)
    scans = []
    for seen in log["scans"]:
        ranges = np.nan_to_num(np.array(seen["ranges"]), nan=2 * FARTHEST, posinf=2 * FARTHEST)
        limits = bearings[0], bearings[-1], step, 0.0, 2 * FARTHEST, FARTHEST
        scans.append(models.LocalizedRangeScan(ranges, *limits, *seen["odometry"]))
        slam.process_scan(scans[-1])
        yield None
    slam.run_opt()
    for scan in scans:
        yield [scan.corrected_pose.x, scan.corrected_pose.y, scan.corrected_pose.yaw]


def kiss_icp(log: Log) -> Iterator[Any]:
    """Scan to voxel map, point to point, no loops."""
    config = importlib.import_module("kiss_icp.config").KISSConfig()
    config.data.deskew, config.data.max_range, config.mapping.voxel_size = False, FARTHEST, VOXEL
    config.registration.max_num_threads = 1
    system = importlib.import_module("kiss_icp.kiss_icp").KissICP(config)
    for points, move in driven(log):
        system.last_delta = move
        system.register_frame(points, np.zeros(len(points)))
        yield flat(system.last_pose)


def small_gicp(log: Log) -> Iterator[Any]:
    """Scan to the last scans, generalised ICP, no loops."""
    library, pose = importlib.import_module("small_gicp"), np.eye(4)
    before: deque[Any] = deque(maxlen=SUBMAP)
    for points, move in driven(log):
        standing = np.vstack([points + np.array([0.0, 0.0, height]) for height in HEIGHTS])
        pose = pose @ move
        if before:
            target, tree = library.preprocess_points(np.vstack(before), VOXEL / 5)
            source, _ = library.preprocess_points(standing, VOXEL / 5)
            found = library.align(target, source, tree, pose, max_correspondence_distance=2 * VOXEL)
            pose = found.T_target_source
        before.append(standing @ pose[:3, :3].T + pose[:3, 3])
        yield flat(pose)


def driven(log: Log) -> Iterator[tuple[Any, Any]]:
    """Points (n, 3) of each scan and the odometry's move (4, 4) since the one before."""
    bearings, last = np.array(log["bearings"]), None
    for seen in log["scans"]:
        ranges, here = np.array(seen["ranges"]), raised(seen["odometry"])
        near = ranges < FARTHEST
        across = ranges[near] * np.cos(bearings[near]), ranges[near] * np.sin(bearings[near])
        yield (
            np.column_stack([*across, np.zeros(near.sum())]),
            np.eye(4) if last is None else np.linalg.inv(last) @ here,
        )
        last = here


def raised(pose: list[float]) -> Any:
    """A pose (3,) as a matrix (4, 4)."""
    matrix, cosine, sine = np.eye(4), np.cos(pose[2]), np.sin(pose[2])
    matrix[:2, :2], matrix[:2, 3] = [[cosine, -sine], [sine, cosine]], pose[:2]
    return matrix


def flat(matrix: Any) -> list[float]:
    """A matrix (4, 4) as a pose (3,)."""
    return [matrix[0, 3], matrix[1, 3], float(np.arctan2(matrix[1, 0], matrix[0, 0]))]


SYSTEMS = {"yag-slam": yag_slam, "KISS-ICP": kiss_icp, "small_gicp": small_gicp}


def main(name: str) -> None:
    """Answer with poses and process CPU seconds, without imports."""
    log = json.load(sys.stdin)
    try:
        list(SYSTEMS[name]({**log, "scans": log["scans"][:3]}))
    except ImportError as missing:
        answer: dict[str, Any] = {"absent": f"{name} cannot be imported: {missing}"}
    else:
        clock = process_time()
        poses = [pose for pose in SYSTEMS[name](log) if pose is not None]
        answer = {"poses": poses, "seconds": process_time() - clock}
    sys.stdout.write("\n" + json.dumps(answer) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main(sys.argv[1])
