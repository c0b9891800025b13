"""Half steps: where a surface ends between two beams, one of which met it while the next went past.

The chord from the near reading to the far one would give away the whole step right behind the near one, and with it
the ends of walls: door jambs shrink by up to a beam's width. Either beam speaks for half the step between them.
"""

import numpy as np
from numpy.typing import NDArray

from backend.view import EdgeKind, View

Floats = NDArray[np.float64]


def by_half_steps(view: View) -> View:
    """The view with its jumps in depth drawn half a step aside of either reading; one of a wide beam stays as it is."""
    if view.wide is not None:
        return view
    here = view.boundary - view.origin
    there = np.roll(here, -1, axis=0)
    ranges = np.linalg.norm(here, axis=1), np.linalg.norm(there, axis=1)
    jump = (view.edges == EdgeKind.OCCLUSION) | (view.edges == EdgeKind.NO_RETURN)
    jump &= (np.minimum(*ranges) > 0) & (ranges[0] != ranges[1]) & (np.sum(here * there, axis=1) > 0)
    edge = np.flatnonzero(jump)
    first, second = ranges[0][edge, None], ranges[1][edge, None]
    halfway = here[edge] / first + there[edge] / second
    halfway /= np.linalg.norm(halfway, axis=1, keepdims=True)
    step = view.origin + np.stack([first * halfway, second * halfway], axis=1)
    spread = np.stack([view.spread[edge], np.roll(view.spread, -1)[edge]], axis=1)
    after = np.repeat(edge + 1, 2)
    return View(
        np.insert(view.boundary, after, step.reshape(-1, 2), axis=0),
        np.insert(view.edges, after, np.repeat(view.edges[edge], 2)),
        np.insert(view.spread, after, spread.ravel()),
        view.origin,
        view.openings,
    )
