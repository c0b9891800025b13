"""The one door to numba: hot loops over plain arrays become machine code, cached on disk, with the lock released."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

import numba

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def compiled(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """`function` compiled at its first call and kept in the cache beside its file; the type stays the same.

    Division by zero gives inf or nan as in numpy: no hidden branches, and half the time to compile.
    """
    machine_code: Callable[Arguments, Result] = numba.njit(cache=True, nogil=True, error_model="numpy")(function)
    return machine_code
