"""MuJoCo's passive-force callback of one vessel; its arguments lie in `userdata`.

userdata: parameters (P,); constants (K,); actuators at the begin, in the middle and at the end of
    the step (3 HELD,);
begin of the step [s]; 1 / length of the step [1/s].
"""

from typing import Any

import numpy as np
from numba import carray, types

from boatsim.physics.compiler_internals import compile_callback, pointer_from_integer
from boatsim.physics.kernel.compiling import inlined, lean
from boatsim.physics.signals import Array

from .laws import HELD
from .motion import NQ, K, add_force_and_inertia_to_mujoco

NM = NQ * (NQ + 1) // 2  # stored entries of MuJoCo's joint-space inertia
factor_mass = types.ExternalFunction("mj_factorM", types.void(types.voidptr, types.voidptr))


@inlined
def add_passive_forces(
    t: float, q: Array, qd: Array, user: Array, n: int, f: Array, M: Array
) -> None:
    """Add the vessel's forces and added inertia to MuJoCo's arrays at one stage of a step.

    The time t determines the stage of the Runge-Kutta step and so the actuator values in use.
    """
    act = n + K
    share = (t - user[act + 3 * HELD]) * user[act + 3 * HELD + 1]
    at = np.int64(0) if share < 0.25 else np.int64(HELD) if share < 0.75 else np.int64(2 * HELD)
    add_force_and_inertia_to_mujoco(
        t, q, qd, user[act : act + 3 * HELD], at, user[:n], user[n:act], f, M
    )


@lean
def add_passive_forces_in_place(
    t: float, q: Array, qd: Array, user: Array, f: Array, M: Array
) -> None:
    """Add the vessel's forces and added inertia to MuJoCo's arrays, called from Python.

    It does the same as the native callback.
    """
    add_passive_forces(t, q, qd, user, user.size - 3 * HELD - 2 - K, f, M)


def compile_passive_callback(offsets: dict[str, int], size: int) -> Any:
    """Compile MuJoCo's passive-force callback of one vessel to a C function.

    The callback adds the vessel's forces and added inertia to a simulation.

    Args:
        offsets: Offsets of the fields in MuJoCo's structs, as `compiler_internals.mujoco_layout`
            finds them.
        size: Floats in the `userdata` of the model. The callback leaves models of other sizes
            alone.

    Returns:
        numba's C function; its attribute `ctypes` is what MuJoCo takes.
    """
    of_size, of_time = offsets["nuserdata"], offsets["time"]
    of_q, of_qd, of_user = offsets["qpos"], offsets["qvel"], offsets["userdata"]
    of_f, of_M = offsets["qfrc_passive"], offsets["M"]
    words = max(offsets.values()) + 1
    n = size - 3 * HELD - 2 - K

    def add_passive_forces_to_mujoco(model, data):  # type: ignore[no-untyped-def]
        if carray(model, (of_size + 1,), np.int32)[of_size] != size:
            return
        w = carray(data, (words,), np.int64)
        t = carray(data, (words,), np.float64)[of_time]
        user = carray(pointer_from_integer(w[of_user]), (size,), np.float64)
        q = carray(pointer_from_integer(w[of_q]), (NQ,), np.float64)
        qd = carray(pointer_from_integer(w[of_qd]), (NQ,), np.float64)
        f = carray(pointer_from_integer(w[of_f]), (NQ,), np.float64)
        M = carray(pointer_from_integer(w[of_M]), (NM,), np.float64)
        add_passive_forces(t, q, qd, user, n, f, M)
        factor_mass(model, data)

    return compile_callback(add_passive_forces_to_mujoco)
