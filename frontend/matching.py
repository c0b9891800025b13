"""Matching two sketches: near, when the move is roughly known, and lost, when it is not (Flynn 1988, §4.1).

A knot is what the descriptor says: which of its walls were seen, where they lead, and which side is free. Two faces
of a thin wall have opposite free sides and are never the same knot. A lost match is proposed by constellations of
knots and by the crossings of long walls, and judged by all walls of both sketches, however it was proposed.
"""

from dataclasses import dataclass

import numpy as np

from frontend.agreement import Agreement, agreement
from frontend.constellations import consistent, constellations
from frontend.joint_compatibility import JointPairs, most_joint_pairs
from frontend.pair_pose import PairedKnots, pose_of_pairs
from frontend.primal_sketch import PrimalSketch
from frontend.rigid_motion import transform, wrap
from frontend.scan import Booleans, Floats, Integers
from frontend.wall_crossings import poses_of_crossings, wall_crossings
from frontend.wall_pose import pose_of_walls


@dataclass(frozen=True)
class MatchingSettings:
    """Opinions of the matching; lengths in metres, angles in radians."""

    confidence: float = 0.99  # of the χ² gates; larger accepts more distant pairs
    wall_noise: float = 0.07  # of the direction of a wall; larger trusts positions more than walls
    wall_gate: float = 0.2  # two views of one wall may differ in direction by this; larger accepts more pairs
    distance_gate: float = 0.15  # two views of one distance between knots may differ by this; larger accepts more
    most_knots: int = 15  # knots of each sketch that take part, surest first; larger is slower and finds more
    most_poses: int = 30  # constellations whose pose is judged, largest first; larger is slower and misses less
    contradiction_worth: float = 3.0  # metres laid that a metre in free space outweighs; larger prefers cautious poses
    most_contradiction: float = 0.1  # share of walls that may stand in free space; larger accepts more poses
    least_overlap: float = 0.3  # share of all walls of both that must be laid; larger asks for views closer together
    least_fixing: float = 1.0  # metres of wall laid that hold the pose where it is loosest; larger refuses corridors
    most_rivalry: float = 0.7  # what a distant pose may reach of the best one's score; larger accepts ambiguous ones
    rival_distance: float = 0.5  # metres from which on a pose is another; larger sees fewer rivals
    rival_turn: float = 0.2  # and radians
    wall_tolerance: float = 0.12  # metres two views of a wall may lie apart; larger supports coarser poses
    position_noise: float = 0.03  # metres added to every knot; larger forgives worse covariances


@dataclass(frozen=True, eq=False)
class Matches:
    """Which knots agree. pairs: (p, 2) knots of the fixed and the moving sketch.

    pose_in_fixed: (3,) of the moving sketch, covariance (3, 3), both None when nothing was accepted;
    reason: what decided, in one sentence. residual: root mean square distance of the pairs, metres, nan without any.
    best_guess: (3,) the likeliest pose even if it was not accepted, None where nothing proposed one.
    """

    pairs: Integers
    pose_in_fixed: Floats | None
    covariance: Floats | None
    residual: float
    reason: str
    best_guess: Floats | None = None


def match_near(
    fixed: PrimalSketch, moving: PrimalSketch, guess: Floats, guess_covariance: Floats, settings: MatchingSettings
) -> Matches:
    """Pairs that agree jointly with each other and with the guess (3,) of the moving pose in the fixed frame."""
    a, b = surest_landmarks(fixed, settings.most_knots), surest_landmarks(moving, settings.most_knots)
    if not a.size or not b.size:
        return _nothing(f"{a.size} and {b.size} landmark knots: nothing to pair")
    gate = settings.wall_gate + 3 * float(np.sqrt(guess_covariance[2, 2]))
    turned = wrap(fixed.walls[a][:, None] - moving.walls[b][None] - guess[2])
    alike = same_kind(fixed, a, moving, b, settings) & ~np.any(np.abs(turned) > gate, axis=2)
    joint = JointPairs(
        fixed.positions[a], _noisy(fixed.covariances[a], settings),
        moving.positions[b], _noisy(moving.covariances[b], settings), alike,
    )  # fmt: skip
    pairs = most_joint_pairs(joint, guess, guess_covariance, settings.confidence)
    chosen = np.column_stack([a[pairs[:, 0]], b[pairs[:, 1]]])
    if len(chosen) < 2:
        return _nothing(f"{len(chosen)} of {min(a.size, b.size)} knots agree with the guess: a pose needs two", chosen)
    pose, information, residual = _solved(fixed, moving, chosen, guess, settings)
    reason = f"{len(chosen)} knots agree jointly with the guess, {residual:.3f} m apart"
    return Matches(chosen, pose, np.asarray(np.linalg.inv(information)), residual, reason, pose)


def match_lost(fixed: PrimalSketch, moving: PrimalSketch, settings: MatchingSettings) -> Matches:
    """The pose that lays most walls of both sketches on each other without any guess, if nothing rivals it."""
    by_knots = poses_of_knots(fixed, moving, settings)
    by_walls = poses_of_crossings(wall_crossings(fixed.lines), wall_crossings(moving.lines), settings.wall_gate)
    poses = np.vstack([by_knots, by_walls])
    if not len(poses):
        knots = f"{np.sum(fixed.landmark)} and {np.sum(moving.landmark)} landmark knots"
        return _nothing(f"{knots} form no constellation, and no walls of both cross alike")
    judged = agreement(fixed, moving, poses, settings.wall_tolerance)
    scores = judged.laid - settings.contradiction_worth * judged.against
    best = int(np.argmax(scores))
    pose, information = pose_of_walls(
        fixed.lines, moving.lines, poses[best], settings.wall_tolerance, settings.position_noise
    )
    pairs, residual = coinciding(fixed, moving, pose, settings)
    seen = (
        f"{len(pairs)} knots and {judged.laid[best] / 2:.1f} m of wall coincide, "
        f"{1 - judged.support[best]:.0%} of the walls stand in free space"
    )
    refused = _doubt(judged, best, _rivalry(poses, scores, best, settings), _wall_length(fixed, moving), settings)
    if refused:
        return Matches(pairs, None, None, residual, f"{seen}: {refused}", pose)
    return Matches(pairs, pose, np.asarray(np.linalg.inv(information)), residual, seen, pose)


def _doubt(judged: Agreement, best: int, rivalry: float, wall: float, settings: MatchingSettings) -> str:
    """Why the best pose is not accepted, empty where it is. wall: metres of both sketches together."""
    if 1 - judged.support[best] > settings.most_contradiction:
        return f"not views of one room, as at most {settings.most_contradiction:.0%} may"
    if judged.laid[best] < settings.least_overlap * wall:
        return f"{judged.laid[best] / max(wall, 1e-9):.0%} of all walls, too little in common"
    if judged.fixing[best] < settings.least_fixing:
        return f"{judged.fixing[best]:.1f} m of them keep the pose from sliding, {settings.least_fixing} m are needed"
    if rivalry > settings.most_rivalry:
        return f"another pose does {rivalry:.0%} as well"
    return ""


def _rivalry(poses: Floats, scores: Floats, best: int, settings: MatchingSettings) -> float:
    """The best score of a pose elsewhere, as a share of the best one's."""
    apart = np.hypot(*(poses[:, :2] - poses[best, :2]).T) > settings.rival_distance
    turned = np.abs(wrap(poses[:, 2] - poses[best, 2])) > settings.rival_turn
    elsewhere = scores[apart | turned]
    return float(np.max(elsewhere) / scores[best]) if elsewhere.size and scores[best] > 0 else 0.0


def _wall_length(fixed: PrimalSketch, moving: PrimalSketch) -> float:
    ends = np.concatenate([fixed.lines.ends, moving.lines.ends])
    return float(np.sum(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)))


def poses_of_knots(fixed: PrimalSketch, moving: PrimalSketch, settings: MatchingSettings) -> Floats:
    """The poses (p, 3) that the largest constellations of knots ask for, the largest first."""
    a, b = surest_landmarks(fixed, settings.most_knots), surest_landmarks(moving, settings.most_knots)
    if not a.size or not b.size:
        return np.empty((0, 3))
    i, j = np.nonzero(same_kind(fixed, a, moving, b, settings))
    i, j = a[i], b[j]
    turns = _common_turn(fixed.walls[i], moving.walls[j])
    graph = consistent(fixed.positions[i], moving.positions[j], turns, settings.distance_gate, settings.wall_gate)
    graph &= (i[:, None] != i[None]) & (j[:, None] != j[None])
    posed = [c for c in constellations(graph) if c.size > 1 or not np.isnan(turns[c[0]])]
    largest = sorted(posed, key=len, reverse=True)[: settings.most_poses]
    found = [_solved(fixed, moving, np.column_stack([i[c], j[c]]), None, settings)[0] for c in largest]
    return np.array(found).reshape(-1, 3)


def coinciding(
    fixed: PrimalSketch, moving: PrimalSketch, pose: Floats, settings: MatchingSettings
) -> tuple[Integers, float]:
    """The landmark knots (p, 2) that are one at this pose, each other's nearest, and their RMS distance."""
    a, b = np.flatnonzero(fixed.landmark), np.flatnonzero(moving.landmark)
    if not a.size or not b.size:
        return np.empty((0, 2), np.int64), np.nan
    apart = np.linalg.norm(fixed.positions[a][:, None] - transform(moving.positions[b], pose)[None], axis=2)
    turned = wrap(fixed.walls[a][:, None] - moving.walls[b][None] - pose[2])
    alike = same_kind(fixed, a, moving, b, settings) & ~np.any(np.abs(turned) > settings.wall_gate, axis=2)
    apart = np.where(alike & (apart < settings.distance_gate), apart, np.inf)
    nearest = np.argmin(apart, axis=1)
    both = np.isfinite(np.min(apart, axis=1)) & (np.argmin(apart, axis=0)[nearest] == np.arange(a.size))
    distances = np.min(apart, axis=1)[both]
    return np.column_stack([a[both], b[nearest[both]]]), float(np.sqrt(np.mean(distances**2))) if both.any() else np.nan


def surest_landmarks(sketch: PrimalSketch, most: int) -> Integers:
    """Indices of the landmark knots, at most so many, those with the smallest covariance first, in knot order."""
    landmarks = np.flatnonzero(sketch.landmark)
    doubt = np.trace(sketch.covariances[landmarks], axis1=1, axis2=2)
    return np.sort(landmarks[np.argsort(doubt, kind="stable")[:most]])


def same_kind(
    fixed: PrimalSketch, a: Integers, moving: PrimalSketch, b: Integers, settings: MatchingSettings
) -> Booleans:
    """Whether knots (i,) and (j,) can be one: surface on a common side, the same turn where both walls were seen.

    A jamb shows one wall of a convex corner, whose other wall another place may see. A lone bump, which shows ends
    but no wall, is only ever a bump.
    """
    sides_a, sides_b = _surface_sides(fixed)[a], _surface_sides(moving)[b]
    bump_a = np.all(sides_a, axis=1) & np.all(np.isnan(fixed.walls[a]), axis=1)
    bump_b = np.all(sides_b, axis=1) & np.all(np.isnan(moving.walls[b]), axis=1)
    corner_a, corner_b = np.all(sides_a, axis=1), np.all(sides_b, axis=1)
    turn_a, turn_b = fixed.turns[a], moving.turns[b]
    same_turn = np.abs(wrap(turn_a[:, None] - turn_b[None])) < 2 * settings.wall_gate
    convex = (~corner_a | (turn_a < 0))[:, None] & (~corner_b | (turn_b < 0))[None]
    shared = np.any(sides_a[:, None] & sides_b[None], axis=2) & ~(bump_a[:, None] | bump_b[None])
    alike = shared & np.where(corner_a[:, None] & corner_b[None], same_turn, convex)
    return np.asarray(alike | (bump_a[:, None] & bump_b[None]))


def _surface_sides(sketch: PrimalSketch) -> Booleans:
    """Whether surface leads to and from each knot (k, 2)."""
    return np.column_stack([np.roll(sketch.real, 1), sketch.real])


def _common_turn(walls_a: Floats, walls_b: Floats) -> Floats:
    """The heading (p,) of the moving frame that each pair's common walls ask for, nan where they have none."""
    turned = walls_a - walls_b
    seen = ~np.isnan(turned)
    sine, cosine = np.sum(np.sin(turned), axis=1, where=seen), np.sum(np.cos(turned), axis=1, where=seen)
    return np.where(np.any(seen, axis=1), np.arctan2(sine, cosine), np.nan)


def _noisy(covariances: Floats, settings: MatchingSettings) -> Floats:
    return covariances + settings.position_noise**2 * np.eye(2)


def _solved(
    fixed: PrimalSketch, moving: PrimalSketch, pairs: Integers, guess: Floats | None, settings: MatchingSettings
) -> tuple[Floats, Floats, float]:
    """The pose of the moving sketch from its pairs alone, its information, and the distance left."""
    a, b = pairs.T
    turns = _common_turn(fixed.walls[a], moving.walls[b])
    covariances = _noisy(fixed.covariances[a], settings), _noisy(moving.covariances[b], settings)
    paired = PairedKnots(fixed.positions[a], covariances[0], moving.positions[b], covariances[1], turns)
    return pose_of_pairs(paired, guess, settings.wall_noise)


def _nothing(reason: str, pairs: Integers | None = None) -> Matches:
    return Matches(np.empty((0, 2), np.int64) if pairs is None else pairs, None, None, np.inf, reason)
