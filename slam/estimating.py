"""The estimate of a pose graph: everything solved, refined, and told in the frames of its sessions."""

from collections.abc import Sequence

import numpy as np

from backend.estimate import Decision, Estimate
from backend.factor_graph import FactorGraph
from frontend.rigid_motion import compose
from frontend.scan import Booleans
from slam.main_map import landmarks_in, left_out, main_root
from slam.mapper_settings import MapperSettings
from slam.perception import Percept
from slam.pose_graph import PoseGraph
from slam.refining import refined
from slam.wheels import Wheels

DOUBTED = 5.0  # sigmas by which the rest of the graph contradicts a loop that is reported


def estimated(
    graph: PoseGraph, wheels: Wheels, percepts: Sequence[Percept], fitting: Booleans, settings: MapperSettings
) -> Estimate:
    """The estimate of scans, whose percepts are given, and (n,) whether each fitted anywhere. The graph stays."""
    factors = graph.factors.solved()
    covariances, solved = factors.covariances(), factors.poses
    poses = np.array([compose(solved[k], step) for k, step in graph.relative]).reshape(-1, 3)
    owners = np.array([k for k, _ in graph.relative], np.int64)
    sessions = np.array([keyframe.session for keyframe in graph.keyframes], np.int64)[owners]
    roots = np.array([graph.sessions.root(keyframe.session) for keyframe in graph.keyframes], np.int64)
    # Outlines that a wide beam smeared must not pull at poses that arcs have placed.
    if all(keyframe.percept.arcs is None for keyframe in graph.keyframes):
        # Frame by frame: the wheels tie them to each other by nothing, and their first poses stay.
        for root in np.unique(roots):
            used = np.flatnonzero(fitting & (roots[owners] == root)).tolist()
            moves = wheels.chain(poses, percepts, sessions.tolist(), used)
            poses[used] = refined(poses[used], [percepts[scan] for scan in used], moves, settings.refinement)
    main = main_root(roots[owners])
    landmarks, landmark_ties = landmarks_in(factors, roots == main)
    told = [graph.sessions.told(pose, session) for pose, session in zip(poses, sessions.tolist(), strict=True)]
    return Estimate(
        poses=np.array(told).reshape(-1, 3),
        covariances=covariances[owners],
        landmarks=landmarks - graph.sessions.start(main)[:2],
        sightings=np.bincount([tie.landmark for tie in landmark_ties], minlength=len(landmarks)),
        keyframes=np.array([keyframe.scan for keyframe in graph.keyframes]),
        decisions=(*graph.decisions, *_doubted(graph, factors, settings), *left_out(roots[owners], main)),
        calibration=wheels.calibration,
        mapped=(roots[owners] == main) & fitting,
        ties=tuple(factors.ties),
        landmark_ties=landmark_ties,
    )


def _doubted(graph: PoseGraph, factors: FactorGraph, settings: MapperSettings) -> list[Decision]:
    """Loops that the rest of the graph contradicts, and knots that were not seen often enough to be landmarks."""
    needed = settings.landmarks.proven
    doubted = [
        Decision("landmark", tuple(graph.keyframes[k].scan for k in poses), accepted=False, reason=reason)
        for poses in graph.landmarks.unproven
        for reason in [f"a corner seen {len(poses)} times, but a landmark needs {needed} sightings"]
    ]
    for fixed, moving, sigmas in factors.loop_residuals():
        if sigmas > DOUBTED:
            scans = (graph.keyframes[fixed].scan, graph.keyframes[moving].scan)
            reason = f"the rest of the graph contradicts it by {sigmas:.1f} sigmas"
            doubted.append(Decision("loop", scans, accepted=False, reason=reason))
    return doubted
