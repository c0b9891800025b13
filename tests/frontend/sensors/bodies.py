"""Bodies to put in front of a sensor: boxes and poles of one material, and the surfaces they make together."""

from collections.abc import Sequence

import numpy as np

from frontend.scan import Floats
from frontend.sensors.surfaces import MATERIALS, Material, Surfaces, join_rings

Body = tuple[Floats, list[Material], Floats]


def body(corners: Sequence[Sequence[float]] | Floats, material: Material | str, radius: float = np.inf) -> Body:
    """A body with clockwise corners (k, 2): free space lies on the left of its sides."""
    ring = np.array(corners, float)
    made_of = MATERIALS[material] if isinstance(material, str) else material
    return ring, [made_of] * len(ring), np.full(len(ring), radius)


def block(left: float, bottom: float, right: float, top: float, material: Material | str = "rough") -> Body:
    """An upright box."""
    return body([(left, bottom), (left, top), (right, top), (right, bottom)], material)


def wall_at(distance: float, material: Material | str = "rough", half: float = 40.0) -> Surfaces:
    """A wide wall straight ahead."""
    return surfaces_of(block(distance, -half, distance + 0.2, half, material))


def pole(distance: float, radius: float, material: str = "smooth") -> Body:
    """A round pole straight ahead, its near side at `distance`."""
    turns = -np.linspace(0, 2 * np.pi, 48, endpoint=False)
    return body(
        np.stack([distance + radius + radius * np.cos(turns), radius * np.sin(turns)], axis=1), material, radius
    )


def surfaces_of(*bodies: Body) -> Surfaces:
    """The surfaces of several bodies."""
    rings, materials, radii = zip(*bodies, strict=True)
    return join_rings(list(rings), list(materials), list(radii))
