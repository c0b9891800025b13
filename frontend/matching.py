"""Matching two sketches: near, when the move is roughly known, and lost, when it is not (Flynn 1988, §4.1).

A knot is what the descriptor says: which of its walls were seen, where they lead, and which side is free. Two faces
of a thin wall have opposite free sides and are never the same knot.
"""

from dataclasses import dataclass

import numpy as np

from frontend.constellations import consistent, largest_clique
from frontend.joint_compatibility import JointPairs, most_joint_pairs
from frontend.primal_sketch import KnotKind, PrimalSketch
from frontend.rigid_motion import rotation, transform, wrap
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True)
class MatchingSettings:
    """Opinions of the matching; lengths in metres, angles in radians."""

    confidence: float = 0.99  # of the χ² gates; larger accepts more distant pairs
    wall_gate: float = 0.2  # two views of one wall may differ in direction by this; larger accepts more pairs
    distance_gate: float = 0.15  # two views of one distance between knots may differ by this; larger accepts more
    most_knots: int = 15  # knots of each sketch that take part, surest first; larger is slower and finds more
    least_clique: int = 4  # pairs a constellation needs; larger accepts fewer and surer matches
    position_noise: float = 0.03  # metres added to every knot; larger forgives worse covariances


@dataclass(frozen=True, eq=False)
class Matches:
    """Which knots agree. pairs: (p, 2) knots of the fixed and the moving sketch.

    pose_in_fixed: (3,) of the moving sketch, covariance (3, 3), both None when nothing was accepted;
    reason: what decided, in one sentence. residual: root mean square distance of the pairs, metres.
    """

    pairs: Integers
    pose_in_fixed: Floats | None
    covariance: Floats | None
    residual: float
    reason: str


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
    return _solved(fixed, moving, chosen, guess, settings)


def match_lost(fixed: PrimalSketch, moving: PrimalSketch, settings: MatchingSettings) -> Matches:
    """The largest constellation of knots both sketches share, without any guess."""
    a, b = surest_landmarks(fixed, settings.most_knots), surest_landmarks(moving, settings.most_knots)
    i, j = np.nonzero(same_kind(fixed, a, moving, b, settings)) if a.size and b.size else (np.empty(0, int),) * 2
    if i.size < settings.least_clique:
        return _nothing(f"{i.size} pairs of alike knots: a constellation needs {settings.least_clique}")
    i, j = a[i], b[j]
    turns = _common_turn(fixed.walls[i], moving.walls[j])
    graph = consistent(fixed.positions[i], moving.positions[j], turns, settings.distance_gate, settings.wall_gate)
    graph &= (i[:, None] != i[None]) & (j[:, None] != j[None])
    clique = largest_clique(graph)
    chosen = np.column_stack([i[clique], j[clique]])
    if clique.size < 2:
        return _nothing("no two pairs of knots agree in distance and direction")
    solved = _solved(fixed, moving, chosen, None, settings)
    if clique.size < settings.least_clique:
        reason = f"{clique.size} knots form one constellation: {settings.least_clique} are needed"
        return Matches(chosen, None, None, solved.residual, reason)
    return solved


def surest_landmarks(sketch: PrimalSketch, most: int) -> Integers:
    """Indices of the landmark knots, at most so many, those with the smallest covariance first, in knot order."""
    landmarks = np.flatnonzero(sketch.landmark)
    doubt = np.trace(sketch.covariances[landmarks], axis1=1, axis2=2)
    return np.sort(landmarks[np.argsort(doubt, kind="stable")[:most]])


def same_kind(
    fixed: PrimalSketch, a: Integers, moving: PrimalSketch, b: Integers, settings: MatchingSettings
) -> Booleans:
    """Whether knots (i,) and (j,) can be one: a wall in common, the same turn where both walls were seen.

    A jamb shows one wall of a convex corner; seen from the other side of the corner, both.
    """
    seen_a, seen_b = ~np.isnan(fixed.walls[a]), ~np.isnan(moving.walls[b])
    shared = np.any(seen_a[:, None] & seen_b[None], axis=2)
    jamb_a, jamb_b = fixed.kinds[a] == KnotKind.JAMB, moving.kinds[b] == KnotKind.JAMB
    turn_a, turn_b = fixed.turns[a], moving.turns[b]
    one_jamb = jamb_a[:, None] != jamb_b[None]
    convex = np.where(jamb_a[:, None], turn_b[None] < 0, turn_a[:, None] < 0)
    same_turn = np.abs(wrap(turn_a[:, None] - turn_b[None])) < 2 * settings.wall_gate
    return np.asarray(shared & np.where(one_jamb, convex, (jamb_a[:, None] & jamb_b[None]) | same_turn))


def _common_turn(walls_a: Floats, walls_b: Floats) -> Floats:
    """The heading (p,) of the moving frame that each pair's common walls ask for."""
    turned = walls_a - walls_b
    seen = ~np.isnan(turned)
    sine, cosine = np.sum(np.sin(turned), axis=1, where=seen), np.sum(np.cos(turned), axis=1, where=seen)
    return np.asarray(np.arctan2(sine, cosine))


def _noisy(covariances: Floats, settings: MatchingSettings) -> Floats:
    return covariances + settings.position_noise**2 * np.eye(2)


def _solved(
    fixed: PrimalSketch,
    moving: PrimalSketch,
    pairs: Integers,
    guess: Floats | None,
    settings: MatchingSettings,
) -> Matches:
    """The pose of the moving sketch from its pairs alone, weighted by their covariances."""
    targets, sources = fixed.positions[pairs[:, 0]], moving.positions[pairs[:, 1]]
    pose = _unweighted_pose(targets, sources) if guess is None else guess.copy()
    for _ in range(4):
        turn = rotation(pose[2])
        spread = (
            _noisy(fixed.covariances[pairs[:, 0]], settings)
            + turn @ _noisy(moving.covariances[pairs[:, 1]], settings) @ turn.T
        )
        weights = np.linalg.inv(spread)
        errors = targets - transform(sources, pose)
        slopes = np.zeros((pairs.shape[0], 2, 3))
        slopes[:, :, :2] = np.eye(2)
        slopes[:, :, 2] = sources @ turn.T @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        information = np.einsum("pki,pkl,plj->ij", slopes, weights, slopes)
        step = np.linalg.solve(information, np.einsum("pki,pkl,pl->i", slopes, weights, errors))
        pose = pose + step
    pose[2] = float(wrap(pose[2]))
    residual = float(np.sqrt(np.mean(np.sum((targets - transform(sources, pose)) ** 2, axis=1))))
    how = "form one constellation" if guess is None else "agree jointly with the guess"
    reason = f"{pairs.shape[0]} knots {how}, {residual:.3f} m apart"
    return Matches(pairs, pose, np.linalg.inv(information), residual, reason)


def _unweighted_pose(targets: Floats, sources: Floats) -> Floats:
    """The least-squares rigid motion from sources to targets (p, 2)."""
    a, b = targets - targets.mean(axis=0), sources - sources.mean(axis=0)
    heading = float(np.arctan2(np.sum(b[:, 0] * a[:, 1] - b[:, 1] * a[:, 0]), np.sum(a * b)))
    x, y = targets.mean(axis=0) - rotation(heading) @ sources.mean(axis=0)
    return np.array([x, y, heading])


def _nothing(reason: str, pairs: Integers | None = None) -> Matches:
    return Matches(np.empty((0, 2), np.int64) if pairs is None else pairs, None, None, np.inf, reason)
