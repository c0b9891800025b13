"""Compiled loops: numba behind one typed door, so that strict typing holds inside and outside."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from numba import njit

Inputs = ParamSpec("Inputs")
Output = TypeVar("Output")


def compiled(function: Callable[Inputs, Output]) -> Callable[Inputs, Output]:
    """The function as machine code, kept beside the source between runs."""
    machine_code: Callable[Inputs, Output] = njit(cache=True)(function)
    return machine_code
