"""Thin rectangles: the room map as chains of linked rectangles of width 1 on a 256 × 256 map, and back.

This is the form the paper hands to its planners (Flynn 1988, §4.1 and Fig. 10): every straight piece of the
boundary becomes a very thin rectangle around it, and neighbours share the point where their middle lines meet.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import MultiPolygon

from backend.contours import assemble

Floats = NDArray[np.float64]
WIDTH = 1.0
SIDE = 256.0


class ThinRectangleError(Exception):
    """Rectangles that do not form closed chains; the message says which."""


@dataclass(frozen=True, eq=False)
class ThinRectangles:
    """Chains of rectangles in map units, one closed chain per ring of the free space.

    chains: each (k, 4, 2): start right, end right, end left, start left of the edge, free space on the left.
    origin: (2,) metres of the map's corner; unit: metres per map unit.
    """

    chains: tuple[Floats, ...]
    origin: Floats
    unit: float


def thin_rectangles(free: MultiPolygon, margin: float = 4.0) -> ThinRectangles:
    """The boundary of the free space (metres) as thin rectangles, `margin` units away from the map's rim."""
    x0, y0, x1, y1 = free.bounds
    unit = max(x1 - x0, y1 - y0) / (SIDE - 2 * margin)
    origin = np.array([0.5 * (x0 + x1), 0.5 * (y0 + y1)]) - 0.5 * SIDE * unit
    parts = [shapely.orient_polygons(part) for part in free.geoms]
    rings = [np.asarray(ring.coords)[:-1] for part in parts for ring in (part.exterior, *part.interiors)]
    return ThinRectangles(tuple(_chain((ring - origin) / unit) for ring in rings), origin, unit)


def free_space(rectangles: ThinRectangles) -> MultiPolygon:
    """The free space (metres) that the chains enclose. Raises ThinRectangleError on a chain that is not linked."""
    rings = [
        _ring(number, chain) * rectangles.unit + rectangles.origin for number, chain in enumerate(rectangles.chains)
    ]
    return assemble(rings)


def _chain(ring: Floats) -> Floats:
    """Rectangles (k, 4, 2) of width 1 around the edges of a closed ring (k, 2)."""
    after = np.roll(ring, -1, axis=0)
    along = after - ring
    left = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.linalg.norm(along, axis=1, keepdims=True)
    side = 0.5 * WIDTH * left
    return np.stack([ring - side, after - side, after + side, ring + side], axis=1)


def _ring(number: int, chain: Floats) -> Floats:
    """The middle line (k, 2) of a closed chain."""
    starts, ends = 0.5 * (chain[:, 0] + chain[:, 3]), 0.5 * (chain[:, 1] + chain[:, 2])
    gap = np.linalg.norm(np.roll(starts, -1, axis=0) - ends, axis=1)
    if gap.max() > 1e-6:
        raise ThinRectangleError(
            f"chain {number}: rectangle {int(gap.argmax())} ends {gap.max():.3f} units off its next"
        )
    return starts
