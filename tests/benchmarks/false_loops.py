"""Two ways to be robust against false loops, on the pose graph of the Intel building: a Cauchy kernel, which the back
end uses, and graduated non-convexity (Yang et al. 2020), which GTSAM has too.

Both start from registrations alone, as they drift without loops, and are given the same false ones.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time

import gtsam
import numpy as np
from gtsam.symbol_shorthand import X

from backend.estimate import Estimate, Tie
from backend.factor_graph import FactorGraph, GraphSettings
from frontend.rigid_motion import between, compose
from frontend.scan import Floats, Scan
from slam.recordings import open_recording
from slam.scores.trajectories import Spread, read_relations, relation_errors
from tests.benchmarks.pose_stress import FALSE, SEED, UNCHANGED
from tests.benchmarks.poses import Row, mapped, recordings, track_of
from tests.benchmarks.poses import row as figure

FIRM = np.diag([1e-3, 1e-3, 1e-4]) ** 2
CONTRADICTED = 5.0  # sigmas, from which on the mapper calls a loop doubtful


@dataclass(frozen=True, eq=False)
class Solved:
    """Keyframe poses (k, 3), which of the loops were believed, and process CPU seconds."""

    poses: Floats
    believed: list[bool]
    seconds: float


def rows() -> list[Row]:
    """One row per figure. Raises BenchmarkError without the folder of real recordings."""
    path = recordings() / "intel" / "intel.log.gz"
    scans = open_recording(path).scans
    estimate = mapped(scans)[1]
    motions, true = parted(estimate.ties)
    false = lies(true, len(estimate.keyframes), np.random.default_rng(SEED))
    start = reckoned(motions, len(estimate.keyframes))
    by_cauchy, by_gnc = (solve(start, motions, true + false) for solve in (cauchy, gnc))
    alone = cauchy(start, motions, true)
    errors = [error_of(path, scans, estimate, poses) for poses in (by_cauchy.poses, by_gnc.poses, alone.poses, start)]
    return compared(errors, by_cauchy, by_gnc, len(true))


def compared(errors: list[float], by_cauchy: Solved, by_gnc: Solved, true: int) -> list[Row]:
    """Both solvers' errors, CPU seconds and verdicts on the loops, the true ones first."""
    false = len(by_cauchy.believed) - true
    said = [
        f"{name} believes {sum(s.believed[:true])} of {true} true and {sum(s.believed[true:])} of {false} false"
        for name, s in (("Cauchy", by_cauchy), ("GNC", by_gnc))
    ]
    note = f"pose graph without landmarks and joint refinement, from registrations alone; {'; '.join(said)}"
    peers = {"GNC": errors[1], "no false loops": errors[2], "registrations alone": errors[3]}
    own, seconds = {"part": "pose_stress"}, {"GNC": by_gnc.seconds}
    error = figure("intel graph, 20 % false loops: mean translation error", errors[0], "m", peers, note)
    return [
        error | own | {"target": errors[2] + UNCHANGED},
        figure("intel graph, 20 % false loops: solving", by_cauchy.seconds, "s CPU", seconds, note) | own,
    ]


def parted(ties: Sequence[Tie]) -> tuple[list[Tie], list[Tie]]:
    """Ties between neighbours, and loops."""
    return [tie for tie in ties if tie.moving == tie.fixed + 1], [tie for tie in ties if tie.moving != tie.fixed + 1]


def lies(true: Sequence[Tie], count: int, rng: np.random.Generator) -> list[Tie]:
    """Loops between any two keyframes, a metre or so apart at any turn, each with a true one's confidence."""
    found = []
    for model in rng.choice(len(true), round(FALSE * len(true)), replace=False):
        fixed, moving = sorted(rng.choice(count, 2, replace=False).tolist())
        pose = rng.uniform(-1, 1, 3) * (1.0, 1.0, np.pi)
        found.append(replace(true[model], fixed=fixed, moving=moving, pose=pose))
    return found


def reckoned(motions: Sequence[Tie], count: int) -> Floats:
    """Poses (k, 3) from the first tie of each neighbour pair, which is the registration."""
    steps: dict[int, Floats] = {}
    for tie in motions:
        steps.setdefault(tie.moving, tie.pose)
    poses = [np.zeros(3)]
    for moving in range(1, count):
        poses.append(compose(poses[-1], steps[moving]))
    return np.array(poses)


def cauchy(start: Floats, motions: Sequence[Tie], loops: Sequence[Tie]) -> Solved:
    """The back end's own graph."""
    graph = FactorGraph(GraphSettings())
    for index, pose in enumerate(start):
        graph.add_pose(index, pose)
    graph.anchor(0, start[0], FIRM)
    for tie in motions:
        graph.add_motion(tie.fixed, tie.moving, tie.pose, covariance_of(tie))
    for tie in loops:
        graph.add_loop(tie.fixed, tie.moving, tie.pose, covariance_of(tie))
    clock = process_time()
    graph.solve()
    seconds = process_time() - clock
    return Solved(graph.poses, [sigmas <= CONTRADICTED for _, _, sigmas in graph.loop_residuals()], seconds)


def covariance_of(tie: Tie) -> Floats:
    """(3, 3) in the moving one's axes."""
    return np.asarray(np.linalg.inv(tie.information), np.float64)


def gnc(start: Floats, motions: Sequence[Tie], loops: Sequence[Tie]) -> Solved:
    """GTSAM's graduated non-convexity at its defaults; neighbours are known to be true."""
    graph, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    for index, pose in enumerate(start):
        values.insert(X(index), gtsam.Pose2(*pose))
    graph.add(gtsam.PriorFactorPose2(X(0), gtsam.Pose2(*start[0]), gtsam.noiseModel.Gaussian.Covariance(FIRM)))
    for tie in (*motions, *loops):
        noise = gtsam.noiseModel.Gaussian.Information(tie.information)
        graph.add(gtsam.BetweenFactorPose2(X(tie.fixed), X(tie.moving), gtsam.Pose2(*tie.pose), noise))
    sure = 1 + len(motions)
    parameters = gtsam.GncLMParams(gtsam.LevenbergMarquardtParams())
    parameters.setKnownInliers(list(range(sure)))
    clock = process_time()
    optimizer = gtsam.GncLMOptimizer(graph, values, parameters)
    best = optimizer.optimize()
    seconds = process_time() - clock
    poses = gtsam.utilities.extractPose2(best).reshape(-1, 3)
    return Solved(poses, [weight > 0.5 for weight in optimizer.getWeights()[sure:]], seconds)


def error_of(path: Path, scans: Sequence[Scan], estimate: Estimate, keyframes: Floats) -> float:
    """Mean translation error of all scans, each carried along with the last keyframe before it."""
    owner = np.searchsorted(estimate.keyframes, np.arange(len(scans)), side="right") - 1
    poses = [
        compose(keyframes[k], between(estimate.poses[estimate.keyframes[k]], pose))
        for k, pose in zip(owner, estimate.poses, strict=True)
    ]
    relations = read_relations(path.with_suffix("").with_suffix(".relations"))
    return Spread.of(relation_errors(track_of(path, scans, np.array(poses)), relations)[0]).mean
