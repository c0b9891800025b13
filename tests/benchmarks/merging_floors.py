"""Merging on seven real floors: the same measures and rivals as on the random plans."""

from typing import Any

from tests.benchmarks.merging import against_peers
from tests.benchmarks.merging_cases import FLOORS, floor_case


def rows() -> list[dict[str, Any]]:
    """All rows of the part; the drawings are read from the folder that ROOMSKETCH_DATA names."""
    return against_peers("mlstruct floors", [floor_case(floor) for floor in FLOORS])
