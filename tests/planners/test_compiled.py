"""Loops say when they are about to be compiled, once."""

import numba

from planners import configuration_space
from planners.channels import search
from planners.compiled import compiled, compiling
from planners.configuration_space import ConfigurationSpaceSettings
from tests.planners.known_worlds import LONG, corner, corner_query, door


def test_compiling_is_told_once_and_not_again_when_the_code_is_there() -> None:
    doubled = numba.njit(lambda number: 2 * number)
    heard: list[str] = []
    with compiling(lambda: heard.append("now")):
        doubled(1.0)
        doubled(1)
    assert heard == ["now"]
    with compiling(lambda: heard.append("again")):
        doubled(2.0)
    assert heard == ["now"]


def test_division_by_zero_gives_infinity_in_machine_code() -> None:
    assert inverse(0.0) == float("inf")


@compiled
def inverse(number: float) -> float:
    return 1.0 / number


def test_searches_are_compiled_once_for_all_who_call_them() -> None:
    configuration_space.plan(door(9), LONG, [15, 45, 1.2], [85, 15, -2.0], ConfigurationSpaceSettings(resolution=0.5))
    configuration_space.plan(corner(12.5), LONG, *corner_query(12.5), ConfigurationSpaceSettings(resolution=0.5))
    assert len(search.signatures) == 1  # type: ignore[attr-defined]
