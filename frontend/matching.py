"""Matching two sketches: near, when the move is roughly known, and lost, when it is not (Flynn 1988, §4.1).

A knot is what the descriptor says: which of its walls were seen, where they lead, and which side is free. Two faces
of a thin wall have opposite free sides and are never the same knot.
"""

from dataclasses import dataclass

import numpy as np

from frontend.agreement import agreement
from frontend.constellations import consistent, constellations
from frontend.joint_compatibility import JointPairs, most_joint_pairs
from frontend.pair_pose import PairedKnots, pose_of_pairs
from frontend.primal_sketch import PrimalSketch
from frontend.rigid_motion import wrap
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True)
class MatchingSettings:
    """Opinions of the matching; lengths in metres, angles in radians."""

    confidence: float = 0.99  # of the χ² gates; larger accepts more distant pairs
    wall_noise: float = 0.07  # of the direction of a wall; larger trusts positions more than walls
    wall_gate: float = 0.2  # two views of one wall may differ in direction by this; larger accepts more pairs
    distance_gate: float = 0.15  # two views of one distance between knots may differ by this; larger accepts more
    most_knots: int = 15  # knots of each sketch that take part, surest first; larger is slower and finds more
    most_poses: int = 30  # constellations whose pose is verified, largest first; larger is slower and misses less
    least_clique: int = 3  # pairs a constellation needs, walls agreeing; larger accepts fewer and surer matches
    least_support: float = 0.5  # share of walls in common view that must coincide; larger accepts fewer poses
    most_contradiction: float = 0.15  # share of walls that may stand in free space; larger accepts more poses
    wall_tolerance: float = 0.12  # metres two views of a wall may lie apart; larger supports coarser poses
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
    pose, information, residual = _solved(fixed, moving, chosen, guess, settings)
    reason = f"{len(chosen)} knots agree jointly with the guess, {residual:.3f} m apart"
    return Matches(chosen, pose, np.asarray(np.linalg.inv(information)), residual, reason)


def match_lost(fixed: PrimalSketch, moving: PrimalSketch, settings: MatchingSettings) -> Matches:
    """The largest constellation of knots both sketches share, without any guess."""
    a, b = surest_landmarks(fixed, settings.most_knots), surest_landmarks(moving, settings.most_knots)
    i, j = np.nonzero(same_kind(fixed, a, moving, b, settings)) if a.size and b.size else (np.empty(0, int),) * 2
    if not i.size:
        return _nothing(f"no alike knots among {a.size} and {b.size}")
    i, j = a[i], b[j]
    turns = _common_turn(fixed.walls[i], moving.walls[j])
    graph = consistent(fixed.positions[i], moving.positions[j], turns, settings.distance_gate, settings.wall_gate)
    graph &= (i[:, None] != i[None]) & (j[:, None] != j[None])
    cliques = [c for c in constellations(graph) if c.size > 1 or not np.isnan(turns[c[0]])]
    if not cliques:
        return _nothing("no pair of knots gives a direction, and no two agree in their distance")
    largest = sorted(cliques, key=len, reverse=True)[: settings.most_poses]
    return _verified(fixed, moving, [np.column_stack([i[c], j[c]]) for c in largest], settings)


def _verified(fixed: PrimalSketch, moving: PrimalSketch, found: list[Integers], settings: MatchingSettings) -> Matches:
    """The constellation whose pose lays the most walls on walls and the fewest in free space, if it is good enough."""
    solved = [_solved(fixed, moving, pairs, None, settings) for pairs in found]
    judged = [agreement(fixed, moving, pose, settings.wall_tolerance) for pose, _, _ in solved]
    scores = [len(pairs) + 4 * support - 8 * against for pairs, (support, against) in zip(found, judged, strict=True)]
    k = int(np.argmax(scores))
    pairs, (pose, information, residual), (support, against) = found[k], solved[k], judged[k]
    seen = (
        f"{len(pairs)} knots form one constellation, {residual:.3f} m apart; "
        f"{support:.0%} of the walls coincide, {against:.0%} stand in free space"
    )
    if len(pairs) < settings.least_clique:
        return Matches(pairs, None, None, residual, f"{seen}: {settings.least_clique} pairs are needed")
    if support < settings.least_support or against > settings.most_contradiction:
        return Matches(pairs, None, None, residual, f"{seen}: not views of one room")
    return Matches(pairs, pose, np.asarray(np.linalg.inv(information)), residual, seen)


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
