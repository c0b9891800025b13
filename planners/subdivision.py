"""Configuration space cut into boxes: a tree of halvings, with links between the boxes that share a face.

Only MIXED boxes are cut, across the longest of 2hx, 2hy and 2ρh. Links are kept between boxes that may hold free
configurations; a link says through which face it goes, so cutting a box only touches the links of that box.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planners.cells import FULL, MIXED, SMALL, SPLIT, Walls, label_box
from planners.compiled import compiled, kernel
from planners.outline import Outline

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

SECTORS = 4  # boxes around the circle at the root: half widths below a right angle, no box its own neighbour twice
LINKS_PER_CELL = 16
WALLS_PER_CELL = 24

CELLS, LINKS, FREED, NEAR = 0, 1, 2, 3  # what Tree.used counts; FREED is the first of the links to use again, or −1


class Tree(NamedTuple):
    """All boxes ever made, in preallocated rows.

    lows, highs (n, 3); labels (n,); walls (n, 2) where the walls near a box begin in `near` and how many;
    witness (n,) the wall that made a box FULL; first (n,) its first link; links (l, 5): to, twin, next, previous, face.
    Faces: 0 −x, 1 +x, 2 −y, 3 +y, 4 −θ, 5 +θ, and 6, 7 like 4, 5 but across the end of the period.
    """

    lows: Floats
    highs: Floats
    labels: NDArray[np.int8]
    walls: NDArray[np.int64]
    witness: Ints
    first: Ints
    links: Ints
    near: Ints
    used: NDArray[np.int64]
    reach: float
    smallest: float


def plant(outer: Outline, core: Outline, walls: Walls, frame: Floats, limits: tuple[float, float, int]) -> Tree:
    """The root boxes over `frame` (2, 3), low and high. limits: robot's reach, smallest width, number of boxes."""
    reach, smallest, capacity = limits
    tree = Tree(
        np.empty((capacity, 3)),
        np.empty((capacity, 3)),
        np.empty(capacity, dtype=np.int8),
        np.zeros((capacity, 2), dtype=np.int64),
        np.full(capacity, -1, dtype=np.int32),
        np.empty(capacity, dtype=np.int32),
        np.empty((LINKS_PER_CELL * capacity, 5), dtype=np.int32),
        np.empty(WALLS_PER_CELL * capacity + SECTORS * len(walls.ends), dtype=np.int32),
        np.array([0, 0, -1, 0]),
        reach,
        smallest,
    )
    cuts = np.linspace(frame[0, 2], frame[1, 2], SECTORS + 1)
    every = np.arange(len(walls.ends), dtype=np.int32)
    for sector in range(SECTORS):
        low, high = np.append(frame[0, :2], cuts[sector]), np.append(frame[1, :2], cuts[sector + 1])
        add_box(tree, outer, core, walls, np.stack([low, high]), every)
    for sector in range(SECTORS):
        if tree.labels[sector] != FULL and tree.labels[(sector + 1) % SECTORS] != FULL:
            connect(tree, sector, (sector + 1) % SECTORS, 7 if sector + 1 == SECTORS else 5)
    return tree


@compiled
def add_box(tree: Tree, outer: Outline, core: Outline, walls: Walls, ends: Floats, near: Ints) -> None:
    """A new box between `ends` (2, 3), labelled, without links."""
    cell, begin = tree.used[CELLS], tree.used[NEAR]
    box = np.empty(6)
    for axis in range(3):
        tree.lows[cell, axis], tree.highs[cell, axis] = ends[0, axis], ends[1, axis]
        box[axis], box[axis + 3] = (ends[0, axis] + ends[1, axis]) / 2, (ends[1, axis] - ends[0, axis]) / 2
    label, count, witness = label_box(outer, core, walls, box, near, tree.near[begin:])
    tree.walls[cell, 0], tree.walls[cell, 1] = begin, count
    tree.witness[cell], tree.first[cell] = witness, -1
    if label == MIXED and max(box[3], box[4], tree.reach * box[5]) * 2 <= tree.smallest:
        label = SMALL
    tree.labels[cell] = label
    tree.used[CELLS] += 1
    tree.used[NEAR] += count


@kernel
def _add_link(tree: Tree, source: int, target: int, face: int) -> int:
    link = tree.used[FREED]
    if link >= 0:
        tree.used[FREED] = tree.links[link, 2]
    else:
        link = tree.used[LINKS]
        tree.used[LINKS] += 1
    head = tree.first[source]
    tree.links[link, 0], tree.links[link, 2], tree.links[link, 3], tree.links[link, 4] = target, head, -1, face
    if head >= 0:
        tree.links[head, 3] = link
    tree.first[source] = link
    return int(link)


@compiled
def connect(tree: Tree, source: int, target: int, face: int) -> None:
    """Link two boxes both ways; `face` is the one through which `source` is left."""
    there, back = _add_link(tree, source, target, face), _add_link(tree, target, source, face ^ 1)
    tree.links[there, 1], tree.links[back, 1] = back, there


@kernel
def _drop_link(tree: Tree, owner: int, link: int) -> None:
    following, previous = tree.links[link, 2], tree.links[link, 3]
    if previous >= 0:
        tree.links[previous, 2] = following
    else:
        tree.first[owner] = following
    if following >= 0:
        tree.links[following, 3] = previous
    tree.links[link, 2] = tree.used[FREED]
    tree.used[FREED] = link


@kernel
def has_room(tree: Tree, cell: int) -> bool:
    """Whether the rows suffice to cut `cell`."""
    spare_links = tree.links.shape[0] - tree.used[LINKS] > 4096
    spare_near = tree.near.size - tree.used[NEAR] > 2 * tree.walls[cell, 1]
    return bool(tree.labels.size - tree.used[CELLS] > 2 and spare_links and spare_near)


@kernel
def cut(tree: Tree, outer: Outline, core: Outline, walls: Walls, cell: int) -> None:
    """Halve a MIXED box; the halves are the two newest rows."""
    ends, axis, widest = np.empty((2, 3)), 0, 0.0
    for k in range(3):
        ends[0, k], ends[1, k] = tree.lows[cell, k], tree.highs[cell, k]
        width = (ends[1, k] - ends[0, k]) * (tree.reach if k == 2 else 1.0)
        if width > widest:
            axis, widest = k, width
    middle = (ends[0, axis] + ends[1, axis]) / 2
    near = tree.near[tree.walls[cell, 0] : tree.walls[cell, 0] + tree.walls[cell, 1]]
    lower = tree.used[CELLS]
    upper = lower + 1
    for half in range(2):
        ends[0, axis] = middle if half == 1 else tree.lows[cell, axis]
        ends[1, axis] = middle if half == 0 else tree.highs[cell, axis]
        add_box(tree, outer, core, walls, ends, near)
    tree.labels[cell] = SPLIT
    _hand_over(tree, cell, axis, middle)
    if tree.labels[lower] != FULL and tree.labels[upper] != FULL:
        connect(tree, lower, upper, 2 * axis + 1)


@kernel
def _hand_over(tree: Tree, cell: int, axis: int, middle: float) -> None:
    """Give the links of a cut box to the halves that they touch."""
    lower, upper = tree.used[CELLS] - 2, tree.used[CELLS] - 1
    while tree.first[cell] >= 0:
        link = tree.first[cell]
        other, twin, face = tree.links[link, 0], tree.links[link, 1], tree.links[link, 4]
        _drop_link(tree, cell, link)
        _drop_link(tree, other, twin)
        through = min(face // 2, 2)
        touches_lower = face % 2 == 0 if through == axis else tree.lows[other, axis] < middle
        touches_upper = face % 2 == 1 if through == axis else tree.highs[other, axis] > middle
        if touches_lower and tree.labels[lower] != FULL:
            connect(tree, lower, other, face)
        if touches_upper and tree.labels[upper] != FULL:
            connect(tree, upper, other, face)
