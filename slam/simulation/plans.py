"""The floor plans that the shipped recordings were made in, by the name of their file."""

from collections.abc import Callable

from slam.simulation.buildings import apartment, office
from slam.simulation.floors import Plan
from slam.simulation.scenes import basement, closet_door, doorway_ahead, two_doors

PLANS: dict[str, Callable[[], Plan]] = {
    "flynn_basement": basement,
    "flynn_closet_door": closet_door,
    "flynn_doorway_ahead": doorway_ahead,
    "flynn_two_doors": two_doors,
    "apartment": apartment,
    "office": office,
}
