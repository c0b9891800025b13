"""Normal equations of views that share lines: where the lines lie is eliminated, what couples the views remains.

A line may shift and turn with the views that measured it, so a room full of them moves freely as a whole, and all
poses are found at once instead of each against the others' last ones.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from backend.cell_lines import CellLines
from backend.samples import Samples

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
SAME_SIDE = float(np.cos(np.radians(20)))  # least cosine between a sample's normal and that of its line
LEAST_TURN = 1e-4  # m²; holds the direction of a line whose samples lie at one place
SOLVED = 1e-3  # of the right side, in the preconditioner's norm: what conjugate gradients may leave
MOST_ROUNDS = 200


class Shared(NamedTuple):
    """How lines couple views: view (k,) and arm (k, 3, 2) of every pair of view and line, line by line; ends (l,) of
    each line's pairs; yielding (l, 2, 2), how far each line shifts and turns under a unit load."""

    view: Ints
    arm: Floats
    ends: Ints
    yielding: Floats


def normal_equations(placed: Samples, weight: Floats, lines: CellLines, poses: Floats) -> tuple[Floats, Floats, Shared]:
    """Of every view a block (v, 3, 3) and a gradient (v, 3), and the coupling of all of them; poses (v, 3).

    Lines that only one view has, and samples that face elsewhere than their line, take no part.
    """
    samples = (placed.points, placed.normals, placed.view, weight)
    blocks, gradient, *shared = _coupled(
        (lines.order, lines.starts), samples, (lines.centres, lines.normals, lines.residuals), poses
    )
    return blocks, gradient, Shared(*shared)


def joined(one: Shared, other: Shared) -> Shared:
    """Two couplings of the same views as one."""
    return Shared(
        np.concatenate([one.view, other.view]),
        np.concatenate([one.arm, other.arm]),
        np.concatenate([one.ends, other.ends + len(one.view)]),
        np.concatenate([one.yielding, other.yielding]),
    )


def solved(blocks: Floats, shared: Shared, right: Floats) -> Floats:
    """The steps (v, 3) for which blocks and coupling give the right side (v, 3): conjugate gradients."""
    return np.asarray(_conjugate_gradients(blocks, tuple(shared), right, SOLVED, MOST_ROUNDS))


@njit(cache=True)
def _coupled(groups, samples, lines, poses):  # type: ignore[no-untyped-def]
    order, starts = groups
    view = samples[2]
    blocks, gradient = np.zeros((len(poses), 3, 3)), np.zeros((len(poses), 3))
    pairs, arms = np.empty(len(order), dtype=np.int64), np.zeros((len(order), 3, 2))
    ends, yielding = np.empty(len(starts), dtype=np.int64), np.empty((len(starts), 2, 2))
    used = count = 0
    for line in range(len(starts) - 1):
        own = order[starts[line] : starts[line + 1]]
        if view[own[0]] == view[own[-1]]:
            continue
        first = used
        used, load = _loaded(own, line, samples, lines, (poses, blocks, gradient, pairs, arms), used)
        if used == first:
            continue
        spread = load[2] + LEAST_TURN * load[0]
        yielding[count, 0, 0], yielding[count, 1, 1] = spread, load[0]
        yielding[count, 0, 1] = yielding[count, 1, 0] = -load[1]
        yielding[count] /= load[0] * spread - load[1] ** 2
        for pair in range(first, used):
            gradient[pairs[pair]] -= arms[pair] @ (yielding[count] @ load[3:])
        ends[count] = used
        count += 1
    return blocks, gradient, pairs[:used].copy(), arms[:used].copy(), ends[:count].copy(), yielding[:count].copy()


@njit(cache=True)
def _loaded(own, line, samples, lines, sums, used):  # type: ignore[no-untyped-def]
    """Add one line's samples to the sums; gives the pairs used so far and Σw, Σws, Σws², Σwr, Σwsr of the line."""
    (points, normals, view, weight), (centres, facing, residuals) = samples, lines
    poses, blocks, gradient, pairs, arms = sums
    first, load, jacobian = used, np.zeros(5), np.array([facing[line, 0], facing[line, 1], 0.0])
    for i in own:
        if normals[i, 0] * jacobian[0] + normals[i, 1] * jacobian[1] <= SAME_SIDE:
            continue
        at, w = view[i], weight[i]
        x, y = points[i, 0] - centres[line, 0], points[i, 1] - centres[line, 1]
        along = y * jacobian[0] - x * jacobian[1]
        jacobian[2] = (points[i, 0] - poses[at, 0]) * jacobian[1] - (points[i, 1] - poses[at, 1]) * jacobian[0]
        if used == first or pairs[used - 1] != at:
            pairs[used] = at
            used += 1
        for a in range(3):
            arms[used - 1, a, 0] += w * jacobian[a]
            arms[used - 1, a, 1] += w * along * jacobian[a]
            gradient[at, a] += w * jacobian[a] * residuals[i]
            for b in range(3):
                blocks[at, a, b] += w * jacobian[a] * jacobian[b]
        load[0] += w
        load[1] += w * along
        load[2] += w * along**2
        load[3] += w * residuals[i]
        load[4] += w * along * residuals[i]
    return used, load


@njit(cache=True)
def _times(blocks, shared, steps):  # type: ignore[no-untyped-def]
    """What steps (v, 3) of the views load them with, their lines giving way."""
    view, arm, ends, yielding = shared
    loads = np.empty_like(steps)
    for at in range(len(steps)):
        for a in range(3):
            loads[at, a] = (blocks[at, a] * steps[at]).sum()
    start = 0
    for line in range(len(ends)):
        shift = turn = 0.0
        for pair in range(start, ends[line]):
            for a in range(3):
                shift += arm[pair, a, 0] * steps[view[pair], a]
                turn += arm[pair, a, 1] * steps[view[pair], a]
        given = yielding[line]
        shift, turn = given[0, 0] * shift + given[0, 1] * turn, given[1, 0] * shift + given[1, 1] * turn
        for pair in range(start, ends[line]):
            for a in range(3):
                loads[view[pair], a] -= arm[pair, a, 0] * shift + arm[pair, a, 1] * turn
        start = ends[line]
    return loads


@njit(cache=True)
def _conjugate_gradients(blocks, shared, right, leave, most):  # type: ignore[no-untyped-def]
    """Preconditioned by the blocks of the views."""
    inverse = np.empty_like(blocks)
    for at in range(len(blocks)):
        inverse[at] = np.linalg.inv(blocks[at])
    steps, rest = np.zeros_like(right), right.copy()
    nearer = _blockwise(inverse, rest)
    towards, left = nearer.copy(), (rest * nearer).sum()
    goal = leave**2 * left
    for _ in range(most):
        if left <= goal:
            break
        load = _times(blocks, shared, towards)
        far = left / (towards * load).sum()
        steps, rest = steps + far * towards, rest - far * load
        nearer = _blockwise(inverse, rest)
        before, left = left, (rest * nearer).sum()
        towards = nearer + left / before * towards
    return steps


@njit(cache=True)
def _blockwise(inverse, rest):  # type: ignore[no-untyped-def]
    nearer = np.empty_like(rest)
    for at in range(len(rest)):
        for a in range(3):
            nearer[at, a] = (inverse[at, a] * rest[at]).sum()
    return nearer
