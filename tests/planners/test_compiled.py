"""Loops say when they are about to be compiled, once."""

import numba

from planners.compiled import compiled, compiling


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
