"""Plain Python instead of compiled code, for break points, prints and coverage: `BOATSIM_DEBUG=1`.

With the environment variable `BOATSIM_DEBUG` set to 1 before boatsim is imported, numba compiles
nothing. The laws of effects and controllers and the kernel (`boatsim/physics/kernel/`) are imported
from the files of the repository and run line by line. Only `laws.py` and `motion.py`, which are
generated for each vessel, lie in the cache folder. A run takes about a thousand times as long. See
`docs/debugging.md`.

Differences from compiled code: a division by zero of two Python floats raises `ZeroDivisionError`
instead of giving inf or nan, `math.sqrt` of a negative number raises `ValueError`, and results may
differ in the last bits.
"""

import os
import sys
from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any

DEBUG = os.environ.get("BOATSIM_DEBUG", "0") not in ("", "0")

if DEBUG:
    os.environ["NUMBA_DISABLE_JIT"] = "1"
    if "numba" in sys.modules:  # it has read its environment variables before
        sys.modules["numba"].config.DISABLE_JIT = 1


def python_function(function: Any) -> Callable[..., Any]:
    """Return the Python function from which numba compiled a given function.

    In debug mode nothing is compiled, and the function itself is returned.

    Args:
        function: A function under one of the decorators of `boatsim.physics.kernel.compiling` or of
            numba.
    """
    found: Callable[..., Any] = getattr(function, "py_func", function)
    return found


@cache
def interpreted(function: Any) -> Callable[..., Any]:
    """Return a function that runs in plain Python, with all compiled functions that it calls.

    For a few hundred calls that is faster than to compile them.

    Args:
        function: A compiled function that calls others by names of its module.
    """
    python = python_function(function)
    if not isinstance(python, FunctionType):
        return python
    names = dict(python.__globals__)
    for name in python.__code__.co_names:
        if hasattr(names.get(name), "py_func"):
            names[name] = interpreted(names[name])
    return FunctionType(python.__code__, names, python.__name__, python.__defaults__)


def is_compiled(function: Any) -> bool:
    """Return whether an object is a function compiled by numba.

    In debug mode, where nothing is compiled, return whether it is a function.

    Args:
        function: Any object.
    """
    return callable(function) if DEBUG else hasattr(function, "py_func")
