"""Joint refinement: all poses and wall faces solved together, as in bundle adjustment with the lines eliminated.

Oriented surface points of all poses are hashed into cells by place and facing side. The points of a cell lie on one
line that nobody knows; eliminating its two parameters leaves an equation among the poses that saw it. The odometry
stays in as its own chain, or a smooth corridor would slide along itself.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from backend.face_cells import LineRules, Sheaf, into_cells, lines_of
from backend.long_faces import Straightness, straightened
from backend.reduced_equations import Equations, Trust, equations_of, solved

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class RefinementSettings:
    """How the faces are cut and how far they are trusted."""

    cells: tuple[float, ...] = (0.5, 0.3)  # metres, one per round; larger bends curved walls straight
    sectors: int = 12  # facing sides told apart; more separates walls that meet at a blunt angle
    stretch: int = 4  # cells of a side of the pieces of wall whose direction their cells take; larger trusts the wheels
    own_direction: float = 3.0  # sigmas off that piece's that a cell keeps its own; larger bends curved walls straight
    least_views: int = 3  # keyframes a cell needs; larger trusts only what many saw
    thickest: float = 0.04  # metres rms of a cell that is still one wall, or twice its spread; larger takes curves
    width: float = 0.03  # Cauchy width of a point off its line, metres, or twice its spread; larger trusts outliers
    finest: float = 0.015  # metres; no point is believed nearer to its line; larger trusts the wheels more
    shared_beams: int = 7  # readings that share one line fit; larger trusts the faces less

    @property
    def rules(self) -> LineRules:
        """What makes a line: its normal may stand a sector and a half off the mean facing side."""
        return LineRules(self.least_views, self.width, self.thickest, float(np.cos(1.5 * np.pi / self.sectors)))

    @property
    def straightness(self) -> Straightness:
        """Which cells take the direction of the wall around them."""
        return Straightness(self.stretch, self.sectors, self.thickest, self.own_direction, self.shared_beams)

    @property
    def trust(self) -> Trust:
        """How far a point is believed."""
        return Trust(self.width, self.finest, self.shared_beams)


@dataclass(frozen=True, eq=False)
class Chain:
    """What the wheels say between successive poses: moves (k − 1, 3) and their covariances (k − 1, 3, 3)."""

    moves: Floats
    covariances: Floats


def refine(poses: Floats, sheaf: Sheaf, chain: Chain, settings: RefinementSettings) -> Floats:
    """Poses (k, 3) at which all faces agree best; the first one stays. RefinementError if they do not settle."""
    refined = poses.copy()
    if len(sheaf.points) == 0:
        return refined
    surface = sheaf.in_order()
    for step, size in enumerate(settings.cells):
        # The grid is shifted each time, so that no wall lies on a border of cells in every round.
        shift = np.array([0.5, 0.25]) * step % 1.0
        cells = into_cells(surface, refined, size, shift, settings.sectors)
        lines = straightened(lines_of(cells, settings.rules), cells.squares, settings.straightness)
        by_faces = equations_of(refined, cells, lines, settings.trust)
        refined = refined - solved(with_wheels(by_faces, refined, chain))
        refined[:, 2] = np.arctan2(np.sin(refined[:, 2]), np.cos(refined[:, 2]))
    return refined


def with_wheels(equations: Equations, poses: Floats, chain: Chain) -> Equations:
    """The equations and what the wheels say of the moves between successive poses (k, 3)."""
    back, forth, errors = _moved(poses, chain.moves)
    information = np.linalg.inv(chain.covariances)
    own, gradient = equations.own.copy(), equations.gradient.copy()
    for end, side in ((slice(None, -1), back), (slice(1, None), forth)):
        pull = side.transpose(0, 2, 1) @ information
        own[end] += pull @ side
        gradient[end] += (pull @ errors[:, :, None])[:, :, 0]
    between = back.transpose(0, 2, 1) @ information @ forth
    return replace(equations, own=own, between=equations.between + between, gradient=gradient)


def _moved(poses: Floats, moves: Floats) -> tuple[Floats, Floats, Floats]:
    """What moving either end of each step does to it (k − 1, 3, 3), and the step's errors (k − 1, 3)."""
    first, second = poses[:-1], poses[1:]
    cosine, sine = np.cos(first[:, 2]), np.sin(first[:, 2])
    x, y = (second - first)[:, 0], (second - first)[:, 1]
    step = np.column_stack([cosine * x + sine * y, -sine * x + cosine * y, second[:, 2] - first[:, 2]])
    errors = step - moves
    errors[:, 2] = np.arctan2(np.sin(errors[:, 2]), np.cos(errors[:, 2]))
    forth = np.zeros((len(first), 3, 3))
    forth[:, 0, 0], forth[:, 0, 1], forth[:, 1, 0], forth[:, 1, 1] = cosine, sine, -sine, cosine
    forth[:, 2, 2] = 1
    back = -forth
    back[:, 0, 2], back[:, 1, 2] = step[:, 1], -step[:, 0]
    return back, forth, errors
