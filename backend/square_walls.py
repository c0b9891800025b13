"""Square walls: most walls of a building stand along or across few directions, and that holds a heading over rooms.

Every wall joins the direction it is nearest to, up to quarter turns, or founds one of its own, as walls of a wing far
askew do. Directions are unknowns of the factor graph, and a wall that turns out not to stand square loses its weight
there (Peasley et al. 2012, who hold walls to one such frame). A wing askew by no more than headings drift cannot be
told from drift, and is bent towards the rest.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from backend.factor_graph import FactorGraph

Integers = NDArray[np.int64]


@dataclass(frozen=True)
class SquareSettings:
    """When a wall is held to stand square to others."""

    sightings: int = 3  # of a wall, before it is; larger waits for surer walls
    askew: float = np.radians(15.0)  # beyond what headings drift, a wall founds a direction; larger founds fewer


class SquareWalls:
    """Grows with the walls of one drive."""

    def __init__(self, settings: SquareSettings) -> None:
        self.settings = settings
        self._directions: list[int] = []  # of this drive, among those of the graph
        self._known: set[int] = set()  # walls that were held to a direction

    def forget(self) -> None:
        """What follows was taken elsewhere, where other directions hold."""
        self._directions.clear()

    def see(self, graph: FactorGraph, sightings: Integers) -> None:
        """Hold walls to a direction; sightings: (w,) how often each wall of the graph was seen by now."""
        for wall in np.flatnonzero(sightings >= self.settings.sightings).tolist():
            if wall not in self._known:
                self._known.add(wall)
                self._hold(graph, wall)

    def _hold(self, graph: FactorGraph, wall: int) -> None:
        heading, headings = float(graph.walls[wall, 2]), graph.directions
        offsets = [(abs(quarter_turns(heading - headings[k])[1]), k) for k in self._directions]
        off, nearest = min(offsets, default=(np.inf, 0))
        if off > self.settings.askew:
            nearest = len(headings)
            self._directions.append(nearest)
            graph.add_direction(nearest, heading)
        turns, _ = quarter_turns(heading - float(graph.directions[nearest]))
        graph.add_square(wall, nearest, turns)


def quarter_turns(angle: float) -> tuple[int, float]:
    """The nearest whole number of quarter turns, and what is left over, in [−π/4, π/4]."""
    turns = round(angle / (np.pi / 2))
    return turns, float(angle - turns * np.pi / 2)
