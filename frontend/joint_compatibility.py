"""Joint compatibility branch and bound: the most pairs that fit one move together (Neira & Tardós 2001).

The joint innovation covariance H P Hᵀ + R is full, because every pair shares the move's error P. In information form
D² = Σ νᵀR⁻¹ν − gᵀ(P⁻¹ + Σ HᵀR⁻¹H)⁻¹g with g = Σ HᵀR⁻¹ν, so a pair is added to a branch in constant time.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from frontend.compiled import compiled
from frontend.rigid_motion import rotation, transform
from frontend.scan import Booleans, Floats, Integers


@dataclass(frozen=True, eq=False)
class JointPairs:
    """Knots that may pair: fixed (a, 2) and moving (b, 2) positions with covariances, alike (a, b) by descriptor."""

    fixed: Floats
    fixed_covariances: Floats
    moving: Floats
    moving_covariances: Floats
    alike: Booleans


def most_joint_pairs(knots: JointPairs, guess: Floats, guess_covariance: Floats, confidence: float) -> Integers:
    """Pairs (p, 2) of fixed and moving knots: as many as are jointly compatible, and of those the closest."""
    turn = rotation(guess[2])
    placed = transform(knots.moving, guess)
    errors = knots.fixed[:, None] - placed[None]
    weights = np.linalg.inv(knots.fixed_covariances[:, None] + (turn @ knots.moving_covariances @ turn.T)[None])
    arms = placed - guess[:2]
    slopes = np.zeros((placed.shape[0], 2, 3))
    slopes[:, :, :2] = np.eye(2)
    slopes[:, 0, 2], slopes[:, 1, 2] = -arms[:, 1], arms[:, 0]
    weighted = np.einsum("bki,abkl->abil", slopes, weights)
    costs = np.einsum("abk,abkl,abl->ab", errors, weights, errors)[..., None]
    pulls = np.einsum("abil,abl->abi", weighted, errors)
    information = np.einsum("abil,blj->abij", weighted, slopes).reshape(*costs.shape[:2], 9)
    prior = np.concatenate([np.zeros(4), np.linalg.inv(guess_covariance).ravel()])
    gates = np.asarray(chi2.ppf(confidence, 2.0 * np.arange(1, knots.fixed.shape[0] + 1)))
    partners = branch_and_bound(knots.alike, np.concatenate([costs, pulls, information], axis=2), prior, gates)
    paired = np.flatnonzero(partners >= 0)
    return np.column_stack([partners[paired], paired])


@compiled
def branch_and_bound(alike: Booleans, terms: Floats, prior: Floats, gates: Floats) -> Integers:
    """The fixed knot of each moving one (b,), −1 for none: the largest jointly compatible set, of those the closest.

    terms: (a, b, 13) what a pair adds: cost νᵀR⁻¹ν, pull HᵀR⁻¹ν (3), information HᵀR⁻¹H (9). prior: (13,) the same
    of the guess. gates: χ² gate by number of pairs, less one.
    """
    moving = alike.shape[1]
    sums = np.zeros((moving + 1, 13))
    sums[0] = prior
    taken = np.full(moving, -2, dtype=np.int64)  # −2: not tried, −1: left out
    count = np.zeros(moving + 1, dtype=np.int64)
    best = np.full(moving, -1, dtype=np.int64)
    most, least = 0, np.inf
    depth = 0
    while depth >= 0:
        if depth == moving:
            distance = _distance(sums[depth])
            if count[depth] > most or (count[depth] == most and distance < least):
                most, least = count[depth], distance
                best[:] = taken
            depth -= 1
        elif count[depth] + moving - depth < most or taken[depth] == -1:
            taken[depth] = -2
            depth -= 1
        else:
            taken[depth] = _next_partner(alike, terms, sums, taken, depth, gates[count[depth]])
            count[depth + 1] = count[depth] + (taken[depth] >= 0)
            depth += 1
    return best


@compiled
def _next_partner(alike: Booleans, terms: Floats, sums: Floats, taken: Integers, depth: int, gate: float) -> int:
    """The next free fixed knot that fits the branch so far, −1 when all were tried; leaves the branch's sums below."""
    candidate = 0 if taken[depth] == -2 else taken[depth] + 1
    while candidate < alike.shape[0]:
        if alike[candidate, depth] and not np.any(taken[:depth] == candidate):
            sums[depth + 1] = sums[depth] + terms[candidate, depth]
            if _distance(sums[depth + 1]) <= gate:
                return int(candidate)
        candidate += 1
    sums[depth + 1] = sums[depth]
    return -1


@compiled
def _distance(sums: Floats) -> float:
    """Squared joint Mahalanobis distance from the sums of one branch."""
    g = sums[1:4].copy()
    return float(sums[0] - np.sum(g * np.linalg.solve(sums[4:].copy().reshape(3, 3), g)))
