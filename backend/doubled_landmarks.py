"""Doubled landmarks: walls and edges that were born again where a drive came back to, and are those of before.

How far two landmarks lie apart is judged under their joint covariance: what a round trip has let drift may differ by
its drift, what was seen a moment ago may not. One drift explains all doubles of a room at once, so each pair that is
taken moves what is believed of the others, and a set of pairs is weighed as a whole (joint compatibility: Neira &
Tardós 2001) against as many neighbours that lie so close by chance.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from backend.arc_association import Belief, Known
from backend.arcs import wrapped

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Pair = tuple[int, int]


@dataclass(frozen=True)
class DoubleSettings:
    """When two landmarks are one."""

    evidence: float = 3.0  # logarithm of the odds against chance; larger unites fewer
    margin: float = 3.0  # by which another answer must be worse, in the same measure; larger refuses more doubtful ones
    drift: float = 25.0  # squared distance of the pair that is taken first; larger undoes greater drifts
    gate: float = 9.2  # squared distance of the others, given the first (χ², 2 degrees of freedom, 1 %)
    crowd: tuple[float, float] = (1.0, 4.0)  # walls by chance in a metre and radian, edges in a square metre
    metres: float = 0.01  # by which the same is found elsewhere; larger unites what lies farther apart
    radians: float = np.radians(0.5)  # by which its heading is
    apart: float = 0.3  # metres between the parts of a wall that were seen; larger joins walls across gaps
    facing: float = np.radians(60.0)  # between rays that meet one edge; larger pools both corners of a wall's end


@dataclass(frozen=True)
class Doubles:
    """The best answer: pairs of (elder, younger) landmarks, as places among the known; whether they are one, and why.

    Evidence is the logarithm of the odds against chance.
    """

    pairs: tuple[Pair, ...]
    one: bool
    reason: str


class _Difference(NamedTuple):
    """How far the younger of two landmarks lies from the elder (2,), its slope (2, c) in columns (c,) of the belief,
    and the covariance (2, 2) that one thing found twice has; crowd: how many lie there by chance."""

    columns: Integers
    slope: Floats
    value: Floats
    variance: Floats
    crowd: float


def doubled(belief: Belief, known: Sequence[Known], pairs: Sequence[Pair], settings: DoubleSettings) -> Doubles | None:
    """Which pairs of (elder, younger) landmarks are one, out of those that may be; None if none lie near enough."""
    possible = [
        pair
        for pair in pairs
        if _alike(belief, known[pair[0]], known[pair[1]], settings)
        and _judged(belief, _difference(belief, known, pair, settings))[1] < settings.drift
    ]
    answers = [_grown(belief, known, possible, seed, settings) for seed in possible]
    if not answers:
        return None
    weight, chosen = max(answers, key=lambda answer: answer[0])
    rivals = [other for other, pairs in answers if any(_contradict(p, q) for p in pairs for q in chosen)]
    walls = sum(known[elder].wall for elder, _ in chosen)
    what = f"like those of before (walls: {walls}, edges: {len(chosen) - walls}), evidence {weight:.1f}"
    if weight < settings.evidence:
        return Doubles(chosen, False, f"{what}: under {settings.evidence:.1f} it may be chance")
    if max(rivals, default=-np.inf) > weight - settings.margin:
        return Doubles(chosen, False, f"{what}: another answer has {max(rivals):.1f}")
    return Doubles(chosen, True, what)


def _grown(
    belief: Belief, known: Sequence[Known], possible: list[Pair], seed: Pair, settings: DoubleSettings
) -> tuple[float, tuple[Pair, ...]]:
    """The evidence of a pair and of all that fit once it is believed, the surest first; and these pairs."""
    chosen, weight, best = list[Pair](), 0.0, seed
    while True:
        difference = _difference(belief, known, best, settings)
        weight += _judged(belief, difference)[0]
        chosen.append(best)
        belief = belief.updated(difference.columns, difference.slope, -difference.value, difference.variance)
        open_pairs = [pair for pair in possible if not any(set(pair) & set(one) for one in chosen)]
        judged = [(*_judged(belief, _difference(belief, known, pair, settings)), pair) for pair in open_pairs]
        fitting = [(gain, pair) for gain, distance, pair in judged if distance < settings.gate and gain > 0]
        if not fitting:
            return weight, tuple(chosen)
        best = max(fitting)[1]


def _contradict(first: Pair, second: Pair) -> bool:
    """Whether two pairs cannot both be: a landmark has one double in one place."""
    return (first[0] == second[0]) != (first[1] == second[1])


def _judged(belief: Belief, difference: _Difference) -> tuple[float, float]:
    """Logarithm of the odds that a difference is none against chance, and its squared Mahalanobis distance."""
    columns, slope, value, variance, crowd = difference
    spread = slope @ belief.covariance[np.ix_(columns, columns)] @ slope.T + variance
    distance = float(value @ np.linalg.solve(spread, value))
    return -distance / 2 - float(np.log(np.linalg.det(spread)) / 2 + np.log(2 * np.pi * crowd)), distance


def _alike(belief: Belief, elder: Known, younger: Known, settings: DoubleSettings) -> bool:
    """Whether two landmarks are of one kind, face one side, and were seen beside each other."""
    if elder.wall != younger.wall:
        return False
    if not elder.wall:
        return abs(wrapped(elder.ray - younger.ray)) < settings.facing
    ours, theirs = _values(belief, elder), _values(belief, younger)
    offset = float((theirs[:2] - ours[:2]) @ np.array([-np.sin(ours[2]), np.cos(ours[2])]))
    beside = (
        offset + younger.start < elder.stop + settings.apart and offset + younger.stop > elder.start - settings.apart
    )
    return beside and abs(wrapped(ours[2] - theirs[2])) < np.pi / 6


def _difference(belief: Belief, known: Sequence[Known], pair: Pair, settings: DoubleSettings) -> _Difference:
    """Edges differ in place; walls in heading, and across the elder in the middle of what was seen of the younger."""
    elder, younger = known[pair[0]], known[pair[1]]
    ours, theirs = _values(belief, elder), _values(belief, younger)
    columns = np.concatenate([one.slot + np.arange(len(ours)) for one in (elder, younger)])
    metres = settings.metres
    if not elder.wall:
        slope = np.hstack([-np.eye(2), np.eye(2)])
        return _Difference(columns, slope, theirs - ours, np.eye(2) * metres**2, settings.crowd[1])
    middle, turn = (younger.start + younger.stop) / 2, wrapped(theirs[2] - ours[2])
    normal = np.array([np.cos(ours[2]), np.sin(ours[2])])
    way = theirs[:2] + middle * np.array([-np.sin(theirs[2]), np.cos(theirs[2])]) - ours[:2]
    swing = normal[0] * way[1] - normal[1] * way[0]
    slope = np.array([[*-normal, swing, *normal, -middle * np.cos(turn)], [0, 0, -1, 0, 0, 1]])
    value = np.array([normal @ way, turn])
    return _Difference(columns, slope, value, np.diag([metres, settings.radians]) ** 2, settings.crowd[0])


def _values(belief: Belief, one: Known) -> Floats:
    return belief.mean[one.slot : one.slot + (3 if one.wall else 2)]
