"""A vessel's forces as a C function that MuJoCo calls without the Python interpreter.

The callback is compiled against the layout of MuJoCo's structs, which
`boatsim.physics.compiler_internals` finds. Where that is not possible the engine uses a callback in
Python and warns: it gives the same numbers many times more slowly.
"""

import warnings
from functools import cache
from typing import Any

from boatsim.errors import BadPhysics, BoatsimWarning
from boatsim.physics.compiled_program import CompiledProgram
from boatsim.physics.compiler_internals import mujoco_layout, mujoco_library


class SlowCallbackWarning(BoatsimWarning):
    """Warning that the forces of a vessel are computed by a slow callback in Python, not in C."""


def compile_native(code: CompiledProgram, size: int) -> Any:
    """Compile the passive-force callback of a vessel to a C function that MuJoCo calls.

    Args:
        code: The vessel's compiled program.
        size: Floats in the `userdata` of the model.

    Returns:
        The C function, as `mujoco.set_mjcb_passive` takes it.

    Raises:
        BadPhysics: The installed MuJoCo differs from what the callback needs; the message holds the
            reason.
    """
    try:
        mujoco_library()
        return code.compile_passive_callback(mujoco_layout(), size).ctypes
    except OSError as error:
        raise BadPhysics(f"the library of MuJoCo cannot be loaded: {error}") from None


@cache
def warn_of_slow_callback(reason: str) -> None:
    """Warn once in a process that the slow force callback in Python is used.

    Args:
        reason: Why the native callback is not used.
    """
    warnings.warn(
        f"MuJoCo's force callback runs in Python, many times slower than compiled code: {reason}",
        SlowCallbackWarning,
        stacklevel=2,
    )
