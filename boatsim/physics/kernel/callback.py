"""MuJoCo's passive-force callback for this vessel: parameters and actuators lie in `userdata`, so nothing is global.

userdata: [parameters..., constants k..., actuators at begin, middle and end of the step..., its begin [s], its inverse
length [1/s]]. Offsets of struct fields are words.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import carray, types
from numba.core import cgutils
from numba.core.ccallback import CFunc
from numba.extending import intrinsic

from boatsim.physics.kernel.compiling import inlined, lean, on_disk
from boatsim.physics.signals import Array

from .laws import HELD
from .motion import NQ, K, add_to_mujoco

NM = NQ * (NQ + 1) // 2  # stored entries of MuJoCo's joint-space inertia
factor_mass = types.ExternalFunction("mj_factorM", types.void(types.voidptr, types.voidptr))


@inlined
def passive(t: float, q: Array, qd: Array, user: Array, n: int, f: Array, M: Array) -> None:
    """Add forces and inertia; the stage of the Runge-Kutta step is known by its time."""
    act = n + K
    share = (t - user[act + 3 * HELD]) * user[act + 3 * HELD + 1]
    at = np.int64(0) if share < 0.25 else np.int64(HELD) if share < 0.75 else np.int64(2 * HELD)
    add_to_mujoco(t, q, qd, user[act : act + 3 * HELD], at, user[:n], user[n:act], f, M)


@lean
def passive_in_place(t: float, q: Array, qd: Array, user: Array, f: Array, M: Array) -> None:
    """What the native callback does, for the callback written in Python."""
    passive(t, q, qd, user, user.size - 3 * HELD - 2 - K, f, M)


@intrinsic
def pointer(context: Any, word: Any) -> Any:
    """An address held in an integer, as a pointer."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(word), generate


def make_native(offsets: dict[str, int], size: int) -> Callable[..., Any]:
    """The callback as a C function for models whose userdata has `size` floats; other models are left alone."""
    of_size, of_time = offsets["nuserdata"], offsets["time"]
    of_q, of_qd, of_user = offsets["qpos"], offsets["qvel"], offsets["userdata"]
    of_f, of_M = offsets["qfrc_passive"], offsets["M"]
    words = max(offsets.values()) + 1
    n = size - 3 * HELD - 2 - K

    def called(model, data):  # type: ignore[no-untyped-def]
        if carray(model, (of_size + 1,), np.int32)[of_size] != size:
            return
        w = carray(data, (words,), np.int64)
        t = carray(data, (words,), np.float64)[of_time]
        user = carray(pointer(w[of_user]), (size,), np.float64)
        q = carray(pointer(w[of_q]), (NQ,), np.float64)
        qd = carray(pointer(w[of_qd]), (NQ,), np.float64)
        f = carray(pointer(w[of_f]), (NQ,), np.float64)
        M = carray(pointer(w[of_M]), (NM,), np.float64)
        passive(t, q, qd, user, n, f, M)
        factor_mass(model, data)

    options = {"nopython": True, "error_model": "numpy"}
    native = on_disk(
        CFunc(called, ((types.voidptr, types.voidptr), types.void), {}, options), called
    )
    native.compile()
    return native
