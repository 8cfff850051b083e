"""MuJoCo's passive-force callback of a vessel as a C function."""

import ctypes
import struct
import sys
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from boatsim.physics.compiler_internals import mujoco_library
from boatsim.physics.native.kinds import REAL, VECTOR, WHOLE
from boatsim.physics.native.translate import Translation

# Words of `boatsim_configure_callback`: fields of `compiler_internals.mujoco_layout`
OFFSETS = ("nuserdata", "time", "qpos", "qvel", "userdata", "qfrc_passive", "M")
ARGUMENTS = (REAL, VECTOR, VECTOR, VECTOR, WHOLE, VECTOR, VECTOR)  # of `add_passive_forces`


@cache
def _callback_source() -> str:
    return (Path(__file__).parent / "callback.h").read_text(encoding="utf-8")


def add_mujoco_callback(program: Translation, module: Any) -> None:
    """Add MuJoCo's passive-force callback of a vessel to the C source of its program.

    Args:
        program: The C source.
        module: The program's package.
    """
    python = sys.modules[f"{module.__name__}.callback"]
    name, _ = program.translate_function(python.add_passive_forces, ARGUMENTS)
    defined = {
        "NQ": module.NQ,
        "NM": module.NQ * (module.NQ + 1) // 2,
        "PARAMETERS_AND_REST": 3 * module.HELD + 2 + module.K,
        "ADD_FORCES": name,
    }
    lines = [f"#define {name} {value}" for name, value in defined.items()]
    program.functions.append("\n".join([*lines, _callback_source()]))


class NativeCallback:
    """The callback of a library, as MuJoCo takes it.

    Attributes:
        ctypes: The C function.
    """

    def __init__(self, function: Any) -> None:
        """Keep the function."""
        self.ctypes = function


def compiled_mujoco_callback(
    library: ctypes.CDLL,
) -> Callable[[Mapping[str, int], int], NativeCallback]:
    """Return `compile_passive_callback` of a program, taken from its C library.

    Args:
        library: The library `simulation`.
    """

    def compile_passive_callback(offsets: Mapping[str, int], size: int) -> NativeCallback:
        factor = ctypes.cast(mujoco_library().mj_factorM, ctypes.c_void_p).value
        words = struct.pack("=9q", *[offsets[name] for name in OFFSETS], size, factor)
        configure = library.boatsim_configure_callback
        configure.argtypes, configure.restype = [ctypes.c_char_p, ctypes.c_void_p], ctypes.c_double
        configure(words, None)
        kind = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
        return NativeCallback(kind(("boatsim_passive_callback", library)))

    return compile_passive_callback
