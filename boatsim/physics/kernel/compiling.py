"""The ways in which numba compiles a vessel's program.

All of them divide as IEEE 754 does instead of raising errors. With `BOATSIM_DEBUG=1`
(`boatsim.physics.debugging`) they return the Python function unchanged.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

from numba import njit

from boatsim.physics.compiler_internals import WITHOUT_REFERENCE_COUNTS, keep_on_disk
from boatsim.physics.debugging import DEBUG, python_function
from boatsim.physics.function_compiler import compile_both_forms


def njit_for_compiled_callers(**options: Any) -> Callable[[Any], Any]:
    """Return a decorator that compiles a function with numba, mainly for compiled callers.

    Args:
        options: Further options of numba's `njit`.
    """

    def decorate(function: Any) -> Any:
        return compile_both_forms(function, {"error_model": "numpy", **options})

    return decorate


def cached_njit(**options: Any) -> Callable[[Any], Any]:
    """Return a decorator that compiles a function with numba and keeps the machine code on disk.

    Args:
        options: Further options of numba's `njit`.
    """

    def decorate(function: Any) -> Any:
        compiled = njit_for_compiled_callers(**options)(function)
        return compiled if DEBUG else keep_on_disk(compiled, function)

    return decorate


# Called from Python or from several functions; kept on disk.
compiled = cached_njit()
# The same for functions that allocate no arrays and call only laws that allocate none.
lean = cached_njit(**WITHOUT_REFERENCE_COUNTS)
# The same, for functions that other threads may run at the same time.
unlocked = cached_njit(nogil=True, **WITHOUT_REFERENCE_COUNTS)
# A part that few vessels call: never inlined, so that it does not lengthen the programs around it.
apart: Any = njit_for_compiled_callers(**WITHOUT_REFERENCE_COUNTS)
# A small part of one or two other functions: numba analyses it again in each of them.
inlined = njit(error_model="numpy", inline="always")
# A large part of many functions: analysed once and inlined by LLVM, which moves what does not
# change out of loops.
merged = njit_for_compiled_callers(forceinline=True, **WITHOUT_REFERENCE_COUNTS)


@cache
def compile_shared_law(law: Any) -> Any:
    """Return an effect's law compiled for inlining into programs; each law once per process."""
    return merged(python_function(law))
